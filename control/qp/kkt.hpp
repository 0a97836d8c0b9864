// The conditions of optimality (Karush, Kuhn, Tucker) of an OcpQp, its cost, and a proof of infeasibility.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "control/qp/largest_entry.hpp"
#include "control/qp/point.hpp"
#include "control/qp/problem.hpp"
#include "control/qp/rows.hpp"

namespace control {

// The largest violation, in absolute terms, of each of the conditions of optimality.
struct KktResidual {
  double stationarity = 0.0;     // gradient of the Lagrangian with respect to x, u and, where σ = 0, ε
  double dynamics = 0.0;         // x_0 and x_{i+1} = A x + B u + c
  double rows = 0.0;             // lo − ε ≤ C x + D u ≤ hi + ε, and ε ≥ 0 where σ > 0
  double multipliers = 0.0;      // λ ≥ 0, including λ_ε
  double complementarity = 0.0;  // λ times its row's distance to the bound

  [[nodiscard]] double Max() const {
    return std::max({stationarity, dynamics, rows, multipliers, complementarity});
  }
};

template <int kNx, int kNu>
[[nodiscard]] KktResidual EvaluateKkt(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point) {
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
    if (i > 0) stationarity_x.Add(gradient_x);  // x_0 is given: its gradient need not vanish
    if (!terminal) stationarity_u.Add(gradient_u);
  }
  residual.dynamics = dynamics.Value();
  residual.stationarity = std::max({residual.stationarity, stationarity_x.Value(), stationarity_u.Value()});
  return residual;
}

template <int kNx, int kNu>
[[nodiscard]] double EvaluateCost(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point) {
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

// True if the multipliers λ ≥ 0 of the hard rows prove that no input sequence satisfies them all (Farkas' lemma): the
// λ-weighted sum of the rows, reduced to the inputs alone by the adjoint of the dynamics, is negative for every input
// within its own hard bounds.
//
// Any feasible trajectory has 0 ≤ Σ λ_lo (C x + D u − lo) + λ_hi (hi − C x − D u) = Σ (dᵢᵀxᵢ + eᵢᵀuᵢ) +
// constant with d = Σ_j C_j (λ_lo − λ_hi), e likewise. The adjoint π_N = d_N, π_i = d_i + Aᵀ π_{i+1} turns it
// into constant + π_0ᵀ x_0 + Σ π_{i+1}ᵀ c_i + Σ (e_i + Bᵀ π_{i+1})ᵀ u_i, whose maximum over the inputs'
// bounds is summed here. An unbounded input must have a zero coefficient, up to the round-off of its terms.
template <int kNx, int kNu>
[[nodiscard]] bool ProvesInfeasible(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point) {
  constexpr double kRoundOff = 1e-9, kRoundOffOfCoefficient = 1e-12;
  double sum = 0.0;
  double magnitude = 0.0;
  const auto add = [&](double term) {
    sum += term;
    magnitude += std::abs(term);
  };
  using VectorX = Eigen::Matrix<double, kNx, 1>;
  using VectorU = Eigen::Matrix<double, kNu, 1>;
  VectorX pi = VectorX::Zero(), pi_terms = VectorX::Zero();  // pi_terms sums the absolute values of π's terms
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

extern template KktResidual EvaluateKkt(const OcpQp<8, 2>&, const OcpQpPoint<8, 2>&);
extern template double EvaluateCost(const OcpQp<8, 2>&, const OcpQpPoint<8, 2>&);
extern template bool ProvesInfeasible(const OcpQp<8, 2>&, const OcpQpPoint<8, 2>&);

}  // namespace control
