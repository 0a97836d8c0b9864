// Where OcpQpSolver starts, cold or from a guess: definitions of the solver's StartRow, StartCold and StartFrom.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "control/qp/ocp_qp_rows.hpp"
#include "control/qp/ocp_qp_solver.hpp"

namespace control {

// Every distance is at least that share of its row's width (of 1 in a wider row) and 1e-3. Where σ > 0 the
// slack starts stationary, with λ_ε ε = μ, so λ_lo + λ_hi must stay below σ + ρ ε.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::StartRow(const OcpQpRow<kNx, kNu>& row, RowWork& work, const VectorX& x,
                                     const VectorU& u, double share, double mu,
                                     const RowMultiplier& at_least) {
  constexpr double kLeastShare = 0.1;  // of σ, for λ_ε
  const double least = share * std::clamp(row.hi - row.lo, 0.0, 1.0) + 1e-3;
  const double value = detail::RowValue(row, x, u);
  const auto side = [&](Side& s, double distance, double lambda) {
    s.t = std::max(distance, least);
    s.lambda = s.present ? std::max(lambda, mu / s.t) : 0.0;
  };
  side(work.lo, value - work.lo.bound, at_least.lo);
  side(work.hi, work.hi.bound - value, at_least.hi);
  double lambda = work.lo.lambda + work.hi.lambda;
  if (!row.exact()) {
    work.epsilon = row.rho > 0.0 ? lambda / row.rho : 0.0;
    return;
  }
  const double violation = std::max(0.0, detail::Violation(work.lo.bound, work.hi.bound, value));
  const double most = row.sigma + row.rho * violation - std::min(kLeastShare * row.sigma, mu / violation);
  if (lambda > most) {
    work.lo.lambda *= most / lambda;
    work.hi.lambda *= most / lambda;
    lambda = most;
  }
  const double half = 0.5 * (row.sigma - lambda);
  const double root = std::sqrt(half * half + row.rho * mu);
  work.slack.lambda = half > 0.0 ? half + root : row.rho * mu / (root - half);
  work.slack.t = work.epsilon = mu / work.slack.lambda;
}

// From the base. Where that violates a row with σ > 0, λ_lo + λ_hi may have to rise to σ: μ starts the
// larger, as steps are short while infeasibility is large beside μ.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::StartCold(const Qp& qp) {
  constexpr double kShare = 0.1;  // of the width, where t starts: λ = σ there needs μ = kShare σ
  constexpr double kMostMu = 100.0;
  double mu = 1.0;
  for (auto& work : work_) {
    work.x.setZero();
    work.u.setZero();
    work.pi.setZero();
  }
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    const bool violated = work_[i].lo[j] > 0.0 || work_[i].hi[j] < 0.0;
    if (row.exact() && violated) mu = std::clamp(kShare * row.sigma, mu, kMostMu);
  });
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    StartRow(row, work_[i].rows[j], work_[i].x, work_[i].u, kShare, mu, {});
  });
}

// From the guess's inputs and multipliers, kept off the boundary so that a row may still change sides. False
// if the guess violates a row by more than the start can bridge: from far outside a cold start takes fewer
// steps.
template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::StartFrom(const Qp& qp, const Point& guess) {
  constexpr double kStartMu = 0.1;
  constexpr double kMaxViolation = 1e-2;
  for (std::size_t i = 0; i < work_.size(); ++i) {
    auto& work = work_[i];
    work.u = guess.stages[i].u - work.base_u;
    work.pi = guess.stages[i].pi - work.base_pi;
    if (i + 1 < work_.size()) work_[i + 1].x = qp.stages[i].A * work.x + qp.stages[i].B * work.u;
    for (std::size_t j = 0; j < static_cast<std::size_t>(qp.stages[i].row_count); ++j) {
      const auto& row = qp.stages[i].rows[j];
      RowWork& at = work.rows[j];
      const double value = detail::RowValue(row, work.x, work.u);
      const double violation = detail::Violation(at.lo.bound, at.hi.bound, value);
      if (!(violation - guess.stages[i].slack[j] <= kMaxViolation)) return false;
      StartRow(row, at, work.x, work.u, 0.02, kStartMu, guess.stages[i].lambda[j]);
    }
  }
  return true;
}

}  // namespace control
