#include "control/vehicle/single_track.hpp"

#include <cmath>

namespace control {

State SingleTrackModel::Derivative(const State& z, const Input& u, const Angles& angles) const {
  const auto& p = parameters_;
  const double upsilon = z[kUpsilon], nu = z[kNu], omega = z[kOmega], delta = u[kDelta];
  const double F_yf = p.C_alpha_f * (delta - (nu + p.l_f * omega) / upsilon);
  const double F_yr = p.C_alpha_r * (p.l_r * omega - nu) / upsilon;
  State f;
  f[kX] = upsilon * angles.cos_psi - nu * angles.sin_psi;
  f[kY] = upsilon * angles.sin_psi + nu * angles.cos_psi;
  f[kUpsilon] = omega * nu + u[kAcceleration];
  f[kNu] = -omega * upsilon + 2.0 / p.m * (F_yf * angles.cos_delta + F_yr);
  f[kPsi] = omega;
  f[kOmega] = 2.0 / p.I_z * (p.l_f * F_yf - p.l_r * F_yr);
  return f;
}

LinearModel SingleTrackModel::Jacobian(const State& z, const Input& u, const Angles& angles) const {
  const auto& p = parameters_;
  const double upsilon = z[kUpsilon], nu = z[kNu], omega = z[kOmega];
  const auto& [sin_psi, cos_psi, sin_delta, cos_delta] = angles;
  // Tangents of the axles' travel angles and derivatives of the forces; ∂F_yf/∂δ = C_αf.
  const double front = (nu + p.l_f * omega) / upsilon, rear = (nu - p.l_r * omega) / upsilon;
  const double f_nu = -p.C_alpha_f / upsilon, f_omega = p.l_f * f_nu, f_upsilon = -front * f_nu;
  const double r_nu = -p.C_alpha_r / upsilon, r_omega = -p.l_r * r_nu, r_upsilon = -rear * r_nu;
  const double F_yf = p.C_alpha_f * (u[kDelta] - front);

  LinearModel d{.A = decltype(LinearModel::A)::Zero(), .B = decltype(LinearModel::B)::Zero()};
  d.A(kX, kUpsilon) = cos_psi;
  d.A(kX, kNu) = -sin_psi;
  d.A(kX, kPsi) = -upsilon * sin_psi - nu * cos_psi;
  d.A(kY, kUpsilon) = sin_psi;
  d.A(kY, kNu) = cos_psi;
  d.A(kY, kPsi) = upsilon * cos_psi - nu * sin_psi;
  d.A(kUpsilon, kNu) = omega;
  d.A(kUpsilon, kOmega) = nu;
  d.A(kNu, kUpsilon) = -omega + 2.0 / p.m * (f_upsilon * cos_delta + r_upsilon);
  d.A(kNu, kNu) = 2.0 / p.m * (f_nu * cos_delta + r_nu);
  d.A(kNu, kOmega) = -upsilon + 2.0 / p.m * (f_omega * cos_delta + r_omega);
  d.A(kPsi, kOmega) = 1.0;
  d.A(kOmega, kUpsilon) = 2.0 / p.I_z * (p.l_f * f_upsilon - p.l_r * r_upsilon);
  d.A(kOmega, kNu) = 2.0 / p.I_z * (p.l_f * f_nu - p.l_r * r_nu);
  d.A(kOmega, kOmega) = 2.0 / p.I_z * (p.l_f * f_omega - p.l_r * r_omega);
  d.B(kUpsilon, kAcceleration) = 1.0;
  d.B(kNu, kDelta) = 2.0 / p.m * (p.C_alpha_f * cos_delta - F_yf * sin_delta);
  d.B(kOmega, kDelta) = 2.0 / p.I_z * p.l_f * p.C_alpha_f;
  return d;
}

SingleTrackModel::Curvature SingleTrackModel::Hessian(const State& z, const Input& u,
                                                      const State& lambda) const {
  constexpr int kD = kStates + kDelta;
  const auto& p = parameters_;
  const double upsilon = z[kUpsilon], nu = z[kNu], omega = z[kOmega];
  const double sin_psi = std::sin(z[kPsi]), cos_psi = std::cos(z[kPsi]);
  const double sin_delta = std::sin(u[kDelta]), cos_delta = std::cos(u[kDelta]);
  const double front = (nu + p.l_f * omega) / upsilon, rear = (nu - p.l_r * omega) / upsilon;
  const double F_yf = p.C_alpha_f * (u[kDelta] - front);
  // Weights of F_yf and F_yr in λᵀf with cos δ held constant; all their second derivatives involve υ.
  const double on_front =
      p.C_alpha_f * (2.0 / p.m * lambda[kNu] * cos_delta + 2.0 / p.I_z * lambda[kOmega] * p.l_f);
  const double on_rear = p.C_alpha_r * (2.0 / p.m * lambda[kNu] - 2.0 / p.I_z * lambda[kOmega] * p.l_r);
  // Cross term of F_yf cos δ.
  const double turned = -2.0 / p.m * lambda[kNu] * sin_delta * p.C_alpha_f;

  Curvature H = Curvature::Zero();
  H(kUpsilon, kUpsilon) = -2.0 * (on_front * front + on_rear * rear) / (upsilon * upsilon);
  H(kUpsilon, kNu) = (on_front + on_rear) / (upsilon * upsilon);
  H(kUpsilon, kOmega) = (on_front * p.l_f - on_rear * p.l_r) / (upsilon * upsilon) - lambda[kNu];
  H(kNu, kOmega) = lambda[kUpsilon];
  H(kUpsilon, kPsi) = -lambda[kX] * sin_psi + lambda[kY] * cos_psi;
  H(kNu, kPsi) = -lambda[kX] * cos_psi - lambda[kY] * sin_psi;
  H(kPsi, kPsi) =
      lambda[kX] * (-upsilon * cos_psi + nu * sin_psi) - lambda[kY] * (upsilon * sin_psi + nu * cos_psi);
  H(kD, kD) = 2.0 * turned - 2.0 / p.m * lambda[kNu] * F_yf * cos_delta;
  H(kUpsilon, kD) = turned * front / upsilon;
  H(kNu, kD) = -turned / upsilon;
  H(kOmega, kD) = -turned * p.l_f / upsilon;
  H = H.selfadjointView<Eigen::Upper>();
  return H;
}

}  // namespace control
