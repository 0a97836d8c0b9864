// Definitions of ocp_qp.hpp's templates; include where they are instantiated.
#pragma once

#include <algorithm>
#include <cmath>

#include "control/qp/ocp_qp.hpp"
#include "control/qp/ocp_qp_rows.hpp"

namespace control {

template <int kNx, int kNu>
bool OcpQpStage<kNx, kNu>::AddStateBound(int index, double lo, double hi, double rho, double sigma) {
  if (row_count == kMaxRows) return false;
  Row& row = rows[static_cast<std::size_t>(row_count++)];
  row = Row{.lo = lo, .hi = hi, .rho = rho, .sigma = sigma, .unit = index};
  row.C[index] = 1.0;
  return true;
}

template <int kNx, int kNu>
bool OcpQpStage<kNx, kNu>::AddInputBound(int index, double lo, double hi, double rho, double sigma) {
  if (row_count == kMaxRows) return false;
  Row& row = rows[static_cast<std::size_t>(row_count++)];
  row = Row{.lo = lo, .hi = hi, .rho = rho, .sigma = sigma, .unit = kNx + index};
  row.D[index] = 1.0;
  row.holds_input = true;
  return true;
}

template <int kNx, int kNu>
bool OcpQpStage<kNx, kNu>::AddRow(const Eigen::Matrix<double, kNx, 1>& C,
                                  const Eigen::Matrix<double, kNu, 1>& D, double lo, double hi, double rho,
                                  double sigma) {
  if (row_count == kMaxRows) return false;
  Row& row = rows[static_cast<std::size_t>(row_count++)];
  row = Row{.C = C, .D = D, .lo = lo, .hi = hi, .rho = rho, .sigma = sigma};
  row.holds_input = !D.isZero(0.0);
  int entries = 0;
  for (int k = 0; k < kNx + kNu; ++k) {
    const double entry = k < kNx ? C[k] : D[k - kNx];
    if (entry != 0.0) row.unit = ++entries == 1 && entry == 1.0 ? k : Row::kGeneral;
  }
  return true;
}

namespace detail {

// largest = max(largest, |value|), where what is not a number counts as infinite.
inline void Raise(double& largest, double value) {
  if (!(std::abs(value) <= largest)) largest = std::isnan(value) ? kNoBound : std::abs(value);
}

// The largest absolute value among vectors, kNoBound if one of them holds a value that is not a number.
template <int kSize>
class LargestEntry {
 public:
  void Add(const Eigen::Matrix<double, kSize, 1>& value) {
    largest_ = largest_.cwiseMax(value.cwiseAbs());
    zero_ += 0.0 * value;
  }
  [[nodiscard]] double Value() const { return zero_.sum() == 0.0 ? largest_.maxCoeff() : kNoBound; }

 private:
  Eigen::Matrix<double, kSize, 1> largest_ = Eigen::Matrix<double, kSize, 1>::Zero();
  Eigen::Matrix<double, kSize, 1> zero_ = Eigen::Matrix<double, kSize, 1>::Zero();
};

}  // namespace detail

template <int kNx, int kNu>
KktResidual EvaluateKkt(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point) {
  KktResidual residual;
  detail::LargestEntry<kNx> stationarity_x, dynamics;
  detail::LargestEntry<kNu> stationarity_u;
  using detail::Raise;
  const int N = qp.horizon();
  dynamics.Add(point.stages[0].x - qp.x0);
  for (int i = 0; i <= N; ++i) {
    const auto& stage = qp.stages[static_cast<std::size_t>(i)];
    const auto& at = point.stages[static_cast<std::size_t>(i)];
    const bool terminal = i == N;
    Eigen::Matrix<double, kNx, 1> gradient_x = stage.Q.cwiseProduct(at.x) + stage.q - at.pi;
    Eigen::Matrix<double, kNu, 1> gradient_u = Eigen::Matrix<double, kNu, 1>::Zero();
    if (!terminal) {
      const auto& next = point.stages[static_cast<std::size_t>(i) + 1];
      gradient_x += stage.A.transpose() * next.pi;
      gradient_u = stage.R.cwiseProduct(at.u) + stage.r + stage.B.transpose() * next.pi;
      dynamics.Add(stage.A * at.x + stage.B * at.u + stage.c - next.x);
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      const auto& row = stage.rows[j];
      const RowMultiplier& lambda = at.lambda[j];
      const double epsilon = row.soft() ? at.slack[j] : 0.0;
      const double value = row.C.dot(at.x) + (terminal ? 0.0 : row.D.dot(at.u));
      const double violation = detail::Violation(row.lo, row.hi, value) - epsilon;
      if (!(violation <= 0.0)) Raise(residual.rows, violation);
      if (lambda.lo == 0.0 && lambda.hi == 0.0 && epsilon == 0.0) continue;
      gradient_x -= row.C * (lambda.lo - lambda.hi);
      gradient_u -= row.D * (lambda.lo - lambda.hi);
      if (row.exact()) {
        const double lambda_epsilon = row.rho * epsilon + row.sigma - lambda.lo - lambda.hi;
        Raise(residual.rows, std::min(0.0, epsilon));
        Raise(residual.multipliers, std::min(0.0, lambda_epsilon));
        Raise(residual.complementarity, lambda_epsilon * epsilon);
      } else if (row.soft()) {
        Raise(residual.stationarity, row.rho * epsilon - lambda.lo - lambda.hi);
      }
      const auto side = [&](bool present, double multiplier, double distance) {
        if (present)
          Raise(residual.complementarity, multiplier * (distance + epsilon));
        else
          Raise(residual.multipliers, multiplier);
      };
      Raise(residual.multipliers, std::min({0.0, lambda.lo, lambda.hi}));
      side(row.has_lo(), lambda.lo, value - row.lo);
      side(row.has_hi(), lambda.hi, row.hi - value);
    }
    if (i > 0) stationarity_x.Add(gradient_x);  // x_0 is given: its gradient is free
    if (!terminal) stationarity_u.Add(gradient_u);
  }
  residual.dynamics = dynamics.Value();
  residual.stationarity = std::max({residual.stationarity, stationarity_x.Value(), stationarity_u.Value()});
  return residual;
}

template <int kNx, int kNu>
double EvaluateCost(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point) {
  double cost = 0.0;
  for (std::size_t i = 0; i < qp.stages.size(); ++i) {
    const auto& stage = qp.stages[i];
    const auto& at = point.stages[i];
    cost += 0.5 * at.x.dot(stage.Q.cwiseProduct(at.x)) + stage.q.dot(at.x);
    if (i + 1 < qp.stages.size()) cost += 0.5 * at.u.dot(stage.R.cwiseProduct(at.u)) + stage.r.dot(at.u);
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      const auto& row = stage.rows[j];
      if (row.soft()) cost += (0.5 * row.rho * at.slack[j] + row.sigma) * at.slack[j];
    }
  }
  return cost;
}

// Any feasible trajectory has 0 ≤ Σ λ_lo (C x + D u − lo) + λ_hi (hi − C x − D u) = Σ (dᵢᵀxᵢ + eᵢᵀuᵢ) +
// constant with d = Σ_j C_j (λ_lo − λ_hi), e likewise. The adjoint π_N = d_N, π_i = d_i + Aᵀ π_{i+1} turns it
// into constant + π_0ᵀ x_0 + Σ π_{i+1}ᵀ c_i + Σ (e_i + Bᵀ π_{i+1})ᵀ u_i, whose maximum over the inputs'
// bounds is summed here. An input without a bound must have no part in it, but for the round-off of its terms.
template <int kNx, int kNu>
bool ProvesInfeasible(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point) {
  constexpr double kRoundOff = 1e-9, kRoundOffOfCoefficient = 1e-12;
  double sum = 0.0;
  double magnitude = 0.0;
  const auto add = [&](double term) {
    sum += term;
    magnitude += std::abs(term);
  };
  using VectorX = Eigen::Matrix<double, kNx, 1>;
  using VectorU = Eigen::Matrix<double, kNu, 1>;
  VectorX pi = VectorX::Zero(), pi_terms = VectorX::Zero();  // and the sum of its terms' absolute values
  for (std::size_t i = qp.stages.size(); i-- > 0;) {
    const auto& stage = qp.stages[i];
    const bool terminal = i + 1 == qp.stages.size();
    VectorX d = VectorX::Zero(), d_terms = VectorX::Zero();
    VectorU e = VectorU::Zero(), e_terms = VectorU::Zero();
    VectorU u_min = VectorU::Constant(-kNoBound), u_max = VectorU::Constant(kNoBound);
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      const auto& row = stage.rows[j];
      if (row.soft()) continue;
      const double lambda_lo = row.has_lo() ? std::max(0.0, point.stages[i].lambda[j].lo) : 0.0;
      const double lambda_hi = row.has_hi() ? std::max(0.0, point.stages[i].lambda[j].hi) : 0.0;
      d += row.C * (lambda_lo - lambda_hi);
      e += row.D * (lambda_lo - lambda_hi);
      d_terms += row.C.cwiseAbs() * (lambda_lo + lambda_hi);
      e_terms += row.D.cwiseAbs() * (lambda_lo + lambda_hi);
      if (row.has_lo()) add(-lambda_lo * row.lo);
      if (row.has_hi()) add(lambda_hi * row.hi);
      if (!terminal && row.unit >= kNx) {
        u_min[row.unit - kNx] = std::max(u_min[row.unit - kNx], row.lo);
        u_max[row.unit - kNx] = std::min(u_max[row.unit - kNx], row.hi);
      }
    }
    if (!terminal) {
      add(pi.dot(stage.c));
      e += stage.B.transpose() * pi;
      e_terms += stage.B.cwiseAbs().transpose() * pi_terms;
      for (int k = 0; k < kNu; ++k) {
        const double worst = std::max(e[k] * u_min[k], e[k] * u_max[k]);
        if (std::isfinite(worst)) {
          add(worst);
        } else if (std::abs(e[k]) > kRoundOffOfCoefficient * e_terms[k]) {
          return false;
        }
      }
      d += stage.A.transpose() * pi;
      d_terms += stage.A.cwiseAbs().transpose() * pi_terms;
    }
    pi = d;
    pi_terms = d_terms;
  }
  add(pi.dot(qp.x0));
  return sum < -kRoundOff * magnitude;
}

}  // namespace control
