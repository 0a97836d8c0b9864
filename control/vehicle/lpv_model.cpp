#include "control/vehicle/lpv_model.hpp"

#include <algorithm>
#include <cmath>

namespace control {

LpvModel::LpvModel(const VehicleParameters& p)
    : beta_f_(2.0 * p.C_alpha_f / p.m),
      beta_r_(2.0 * p.C_alpha_r / p.m),
      gamma_f_(2.0 * p.l_f * p.C_alpha_f / p.I_z),
      gamma_r_(2.0 * p.l_r * p.C_alpha_r / p.I_z),
      l_f_(p.l_f),
      l_r_(p.l_r) {}

LinearModel LpvModel::Continuous(const Scheduling& p) const {
  const double upsilon = std::max(p.upsilon, kMinUpsilon);
  const double beta_f = beta_f_ * std::cos(p.delta);
  LinearModel c{.A = decltype(LinearModel::A)::Zero(), .B = decltype(LinearModel::B)::Zero()};
  c.A(kX, kUpsilon) = std::cos(p.psi);
  c.A(kX, kNu) = -std::sin(p.psi);
  c.A(kY, kUpsilon) = std::sin(p.psi);
  c.A(kY, kNu) = std::cos(p.psi);
  c.A(kUpsilon, kOmega) = p.nu;
  c.A(kNu, kNu) = -(beta_f + beta_r_) / upsilon;
  c.A(kNu, kOmega) = -p.upsilon + (beta_r_ * l_r_ - beta_f * l_f_) / upsilon;
  c.A(kPsi, kOmega) = 1.0;
  c.A(kOmega, kNu) = (gamma_r_ - gamma_f_) / upsilon;
  c.A(kOmega, kOmega) = -(gamma_f_ * l_f_ + gamma_r_ * l_r_) / upsilon;
  c.B(kNu, kDelta) = beta_f;
  c.B(kOmega, kDelta) = gamma_f_;
  c.B(kUpsilon, kAcceleration) = 1.0;
  return c;
}

LinearModel LpvModel::Discrete(const Scheduling& p, double t_s, Discretisation method) const {
  if (method == Discretisation::kZeroOrderHold) return ZeroOrderHold(p, t_s);
  LinearModel d = Continuous(p);
  d.A *= t_s;
  d.A.diagonal().array() += 1.0;
  d.B *= t_s;
  return d;
}

// With p frozen, only w = [ν ω] has dynamics of its own, ẇ = F w + g δ; everything else integrates it:
//   w(t) = Φ w₀ + Γ₁ g δ,   ∫w = Γ₁ w₀ + Γ₂ g δ,   ∫∫w = Γ₂ w₀ + Γ₃ g δ,   Φ = e^{Ft},  Γₖ₊₁ = ∫ Γₖ,  Γ₀ = Φ
//   ψ(t) = ψ₀ + ∫ω,  υ(t) = υ₀ + a t + ν̂ ∫ω,  X(t) = X₀ + cos ψ̂ ∫υ − sin ψ̂ ∫ν, and Y likewise.
// Γₖ comes from its Taylor series over a short step, which is then doubled:
//   Γ₁(2h) = Γ₁ + Φ Γ₁,  Γ₂(2h) = Γ₂ + h Γ₁ + Φ Γ₂,  Γ₃(2h) = Γ₃ + h Γ₂ + h²/2 Γ₁ + Φ Γ₃.
LinearModel LpvModel::ZeroOrderHold(const Scheduling& p, double t_s) const {
  using Matrix2 = Eigen::Matrix2d;
  const LinearModel c = Continuous(p);
  Matrix2 F;
  F << c.A(kNu, kNu), c.A(kNu, kOmega), c.A(kOmega, kNu), c.A(kOmega, kOmega);
  const Eigen::Vector2d g(c.B(kNu, kDelta), c.B(kOmega, kDelta));

  double h = t_s;
  int doublings = 0;
  for (const double norm = F.cwiseAbs().rowwise().sum().maxCoeff(); norm * h > 0.5; ++doublings) h *= 0.5;
  // Γ₃(h) = h³ Σ (Fh)^j / (j+3)!  by Horner's scheme; with |Fh| ≤ 1/2, twelve terms reach round-off.
  constexpr int kTerms = 12;
  const Matrix2 Fh = F * h;
  Matrix2 phi3 = Matrix2::Identity();
  for (int j = kTerms; j >= 1; --j) phi3 = Matrix2::Identity() + Fh * phi3 / (j + 3);
  Matrix2 gamma3 = phi3 * (h * h * h / 6.0);
  Matrix2 gamma2 = F * gamma3 + Matrix2::Identity() * (h * h / 2.0);
  Matrix2 gamma1 = F * gamma2 + Matrix2::Identity() * h;
  Matrix2 phi = F * gamma1 + Matrix2::Identity();
  for (; doublings > 0; --doublings) {
    gamma3 += h * gamma2 + (h * h / 2.0) * gamma1 + (phi * gamma3).eval();
    gamma2 += h * gamma1 + (phi * gamma2).eval();
    gamma1 += (phi * gamma1).eval();
    phi = (phi * phi).eval();
    h *= 2.0;
  }

  const Eigen::Vector2d w_delta = gamma1 * g, int_w_delta = gamma2 * g, int2_w_delta = gamma3 * g;
  const double cos_psi = c.A(kX, kUpsilon), sin_psi = c.A(kY, kUpsilon);
  LinearModel d{.A = decltype(LinearModel::A)::Identity(), .B = decltype(LinearModel::B)::Zero()};
  const auto write_column = [&](auto column, const Eigen::Vector2d& w, const Eigen::Vector2d& int_w,
                                const Eigen::Vector2d& int2_w) {
    const double int_upsilon = p.nu * int2_w[1];
    column[kX] = cos_psi * int_upsilon - sin_psi * int_w[0];
    column[kY] = sin_psi * int_upsilon + cos_psi * int_w[0];
    column[kUpsilon] = p.nu * int_w[1];
    column[kNu] = w[0];
    column[kPsi] = int_w[1];
    column[kOmega] = w[1];
  };
  write_column(d.A.col(kNu), phi.col(0), gamma1.col(0), gamma2.col(0));
  write_column(d.A.col(kOmega), phi.col(1), gamma1.col(1), gamma2.col(1));
  write_column(d.B.col(kDelta), w_delta, int_w_delta, int2_w_delta);
  d.A(kX, kUpsilon) = cos_psi * t_s;
  d.A(kY, kUpsilon) = sin_psi * t_s;
  d.B(kX, kAcceleration) = cos_psi * t_s * t_s / 2.0;
  d.B(kY, kAcceleration) = sin_psi * t_s * t_s / 2.0;
  d.B(kUpsilon, kAcceleration) = t_s;
  return d;
}

}  // namespace control
