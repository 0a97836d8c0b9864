// Definitions of ocp_qp_solver.hpp's template; include where it is instantiated.
//
// The base is the optimum without any row. About it the cost is purely quadratic and the dynamics have no
// constant:
//   min Σ ½ xᵀQx + ½ uᵀRu + Σ_soft ½ρε² + σε   s.t.  x_0 = 0, x' = A x + B u,  lo − ε ≤ C x + D u ≤ hi + ε
// with shifted bounds; x, u, π below are these deviations. So positions of hundreds of metres cost no digits.
//
// The Newton system, with a distance t ≥ 0 and a multiplier λ ≥ 0 for each bound, is in ocp_qp_newton.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "control/qp/ocp_qp_active_set.hpp"
#include "control/qp/ocp_qp_base.hpp"
#include "control/qp/ocp_qp_impl.hpp"
#include "control/qp/ocp_qp_newton.hpp"
#include "control/qp/ocp_qp_rows.hpp"
#include "control/qp/ocp_qp_solver.hpp"
#include "control/qp/ocp_qp_start.hpp"

namespace control {

namespace detail {

// True if every number is finite, but for the infinite bounds that are absent, and no σ negative.
// Comparisons alone would not do: a bound that is not a number looks absent, a weight that is not one looks
// like a hard row's.
template <int kNx, int kNu>
bool HasFiniteData(const OcpQp<kNx, kNu>& qp) {
  // Sums of zero times each number: zero, or not a number. Several, so that one need not wait for the other.
  Eigen::Matrix<double, kNx, 1> zero_x = 0.0 * qp.x0, zero_a = Eigen::Matrix<double, kNx, 1>::Zero();
  Eigen::Matrix<double, kNu, 1> zero_u = Eigen::Matrix<double, kNu, 1>::Zero();
  double zero = 0.0;
  bool ordered = true;
  for (std::size_t i = 0; i < qp.stages.size(); ++i) {
    const auto& stage = qp.stages[i];
    zero_x += 0.0 * stage.Q + 0.0 * stage.q;
    if (i + 1 < qp.stages.size()) {
      for (int k = 0; k < kNx; k += 2) {
        zero_a += 0.0 * stage.A.col(k);
        if (k + 1 < kNx) zero_x += 0.0 * stage.A.col(k + 1);
      }
      for (int k = 0; k < kNu; ++k) zero_a += 0.0 * stage.B.col(k);
      zero_x += 0.0 * stage.c;
      zero_u += 0.0 * stage.R + 0.0 * stage.r;
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      const auto& row = stage.rows[j];
      ordered = ordered && (row.lo < kNoBound) && (row.hi > -kNoBound) && (row.sigma >= 0.0);
      zero += 0.0 * row.rho + 0.0 * row.sigma;
      zero_a += 0.0 * row.C;
      zero_u += 0.0 * row.D;
    }
  }
  return ordered && zero + zero_x.sum() + zero_a.sum() + zero_u.sum() == 0.0;
}

}  // namespace detail

template <int kNx, int kNu>
OcpQpSolver<kNx, kNu>::OcpQpSolver(int horizon, const QpSettings& settings)
    : settings_(settings),
      point_(horizon),
      rollout_(horizon),
      work_(static_cast<std::size_t>(horizon) + 1),
      riccati_(work_.size()),
      sweep_(work_.size()),
      responses_(work_.size()),
      dual_(settings.max_known_rows) {
  known_.reserve(static_cast<std::size_t>(settings.max_known_rows));
  candidates_.reserve(kBatch);
}

template <int kNx, int kNu>
QpResult OcpQpSolver<kNx, kNu>::Solve(const Qp& qp, const Point* guess, const TimeLeft* time_left) {
  QpResult result;
  if (!detail::HasFiniteData(qp) || !SolveBase(qp)) return result;
  const double violation = ShiftRows(qp);
  if (!std::isfinite(violation)) return result;
  WriteBase(qp);
  if (violation == 0.0) {
    return {.status = SolverStatus::kSolved, .kkt_residual = base_error_, .feasible = true};
  }
  result.method = QpMethod::kActiveSet;
  if (const auto status = SolveByActiveSet(qp, guess, time_left, result)) {
    result.status = *status;
  } else {
    result = SolveByInteriorPoint(qp, guess, time_left);
  }
  result.feasible = result.status == SolverStatus::kSolved;
  if (result.status == SolverStatus::kIterationLimit) result.feasible = SettleForFeasible(qp, guess);
  return result;
}

template <int kNx, int kNu>
QpResult OcpQpSolver<kNx, kNu>::SolveByInteriorPoint(const Qp& qp, const Point* guess,
                                                     const TimeLeft* time_left) {
  QpResult result{.method = QpMethod::kInteriorPoint};
  StartRows(qp);
  constexpr double kWild = 1e9;  // a residual from which no guess is worth starting
  if (guess == nullptr || !StartFrom(qp, *guess) || !(Residuals(qp) <= kWild)) StartCold(qp);
  constexpr int kMaxHalvings = 6;
  constexpr double kShort = 0.9;
  double alpha = 1.0;
  double infeasibility = 1.0;  // what is left of the start's residuals of the linear equations
  for (;; ++result.iterations) {
    const double linear = Residuals(qp);
    result.kkt_residual = std::max(linear, complementarity_error_);
    if (!std::isfinite(result.kkt_residual)) return result;
    const bool at_limit = result.iterations == settings_.max_iterations;
    // Some λ are so large that their round-off is above the tolerance: as in the active set.
    const double largest = std::max(linear, at_limit ? distance_error_ : complementarity_error_);
    if (largest <= tolerance_ && row_error_ <= settings_.tolerance) {
      result.status = SolverStatus::kSolved;
      break;
    }
    // Multipliers that prove something grow where steps are short.
    if (row_error_ > tolerance_ && result.iterations >= 3 && alpha < kShort) {
      WriteSolution(qp);
      if (ProvesInfeasible(qp, point_)) {
        result.status = SolverStatus::kInfeasible;
        return result;
      }
    }
    if (at_limit || (time_left != nullptr && !(*time_left)())) {
      result.status = SolverStatus::kIterationLimit;
      break;
    }
    if (!Factorise(qp, true)) return result;
    // Predictor: straight at complementarity zero. How far it gets tells how much centring the corrector
    // needs.
    Step(qp, 0.0, false);
    const double ratio = ComplementarityAfter(StepLength(1.0)) / mu_;
    // A μ far below the tolerance would cost digits (t of the size of round-off) and gain nothing.
    const double target = std::max(ratio * ratio * ratio * mu_, 1e-2 * tolerance_);
    Step(qp, target, true);
    const double keep = std::clamp(1.0 - mu_, 0.995, 1.0 - 1e-8);  // 1 would leave a t of zero
    alpha = StepLength(keep);
    // The second-order term can lead round in a cycle for ever (C. Cartis, Some disadvantages of a
    // Mehrotra-type primal-dual corrector interior point algorithm for linear programming, 2009). A cycle
    // raises μ somewhere. Once the linear equations hold, the start of a step without that term lowers it.
    if (infeasibility <= 1e-2 && ComplementarityAfter(alpha) > mu_) {
      Step(qp, 0.3 * mu_, false);
      alpha = StepLength(keep);
      for (int k = 0; k < kMaxHalvings && ComplementarityAfter(alpha) > mu_; ++k) alpha *= 0.5;
    }
    infeasibility *= 1.0 - alpha;
    Move(qp, alpha);
  }
  WriteSolution(qp);
  return result;
}

// Bounds for deviations from the base. Returns by how much the base violates a row at most; infinite if a row's value is
// not finite.
template <int kNx, int kNu>
double OcpQpSolver<kNx, kNu>::ShiftRows(const Qp& qp) {
  double violation = 0.0;
  has_weightless_rows_ = false;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    auto& work = work_[i];
    const double value = detail::RowValue(row, work.base_x, work.base_u);
    work.lo[j] = row.lo - value;
    work.hi[j] = row.hi - value;
    const double beyond = std::max(work.lo[j], -work.hi[j]);
    if (row.weightless()) {
      has_weightless_rows_ = true;
    } else if (!(beyond <= 0.0)) {
      detail::Raise(violation, beyond);
    }
  });
  return violation;
}

// The interior point's work space for the rows.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::StartRows(const Qp& qp) {
  sides_ = 0;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    RowWork& work = work_[i].rows[j];
    work = RowWork{};
    const auto side = [this](Side& s, bool present, double bound) {
      s.present = present;
      s.bound = bound;
      sides_ += static_cast<int>(present);
    };
    side(work.lo, row.has_lo(), work_[i].lo[j]);
    side(work.hi, row.has_hi(), work_[i].hi[j]);
    side(work.slack, row.exact(), 0.0);
  });
}

// Residuals of all equations but λ t = 0 into the work space, μ, and the errors of the rows. Returns the largest of the
// residuals.
template <int kNx, int kNu>
double OcpQpSolver<kNx, kNu>::Residuals(const Qp& qp) {
  const std::size_t N = work_.size() - 1;
  double largest = 0.0;
  double complementarity = 0.0;
  row_error_ = complementarity_error_ = distance_error_ = 0.0;
  const auto raise = [&](double value) { detail::Raise(largest, value); };
  for (std::size_t i = 0; i <= N; ++i) {
    const auto& stage = qp.stages[i];
    auto& work = work_[i];
    work.r_x = stage.Q.cwiseProduct(work.x) - work.pi;
    work.r_u.setZero();
    if (i < N) {
      work.r_x += detail::Product(stage.A.transpose(), work_[i + 1].pi);
      work.r_u = stage.R.cwiseProduct(work.u) + detail::Product(stage.B.transpose(), work_[i + 1].pi);
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      const auto& row = stage.rows[j];
      RowWork& at = work.rows[j];
      const double value = detail::RowValue(row, work.x, work.u);
      detail::AddRowGradient(row, at.hi.lambda - at.lo.lambda, work.r_x, work.r_u);
      const auto side = [&](Side& s, double distance) {
        if (!s.present) return;
        s.residual = distance - s.t;
        complementarity += s.lambda * s.t;
        detail::Raise(row_error_, s.residual);
        const double away = std::max(s.t, std::abs(distance));
        detail::Raise(complementarity_error_, s.lambda * away);
        detail::Raise(distance_error_, std::min(s.lambda, 1.0) * away);
      };
      side(at.lo, value + at.epsilon - at.lo.bound);
      side(at.hi, at.hi.bound + at.epsilon - value);
      side(at.slack, at.epsilon);
      if (row.soft()) {
        at.r_epsilon = row.rho * at.epsilon + row.sigma - at.lo.lambda - at.hi.lambda - at.slack.lambda;
        raise(at.r_epsilon);
      }
    }
    if (i > 0) raise(work.r_x.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>());
    if (i < N) raise(work.r_u.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>());
  }
  raise(row_error_);
  mu_ = complementarity / std::max(sides_, 1);
  return largest;
}

template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::Move(const Qp& qp, double alpha) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    auto& work = work_[i];
    const auto& sweep = sweep_[i];
    work.x += alpha * sweep.dx;
    work.u += alpha * sweep.du;
    if (i > 0) work.pi += alpha * (sweep.p + detail::Product(riccati_[i].P, sweep.dx));
  }
  const auto side = [&](Side& s) {
    if (!s.present) return;
    s.t += alpha * s.dt;
    s.lambda += alpha * s.dlambda;
  };
  detail::ForEachRow(qp, [&](const auto&, std::size_t i, std::size_t j) {
    RowWork& at = work_[i].rows[j];
    side(at.lo);
    side(at.hi);
    side(at.slack);
    at.epsilon += alpha * at.depsilon;
  });
}

// Gives the soft rows the slacks that they need at the point's x, u. Returns the cost; infinite if a hard row does not
// hold, or a number is not finite.
template <int kNx, int kNu>
double OcpQpSolver<kNx, kNu>::FillSlacks(const Qp& qp, Point& point) const {
  bool hold = true;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    auto& at = point.stages[i];
    const double violation = detail::Violation(row.lo, row.hi, detail::RowValue(row, at.x, at.u));
    at.slack[j] = row.soft() ? std::max(0.0, violation) : 0.0;
    hold = hold && (row.soft() || violation <= settings_.tolerance);
  });
  const double cost = EvaluateCost(qp, point);
  if (!hold || !std::isfinite(cost)) return kNoBound;
  return cost;
}

// Makes the best of a solve that was stopped. True if solution() is feasible.
template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::SettleForFeasible(const Qp& qp, const Point* guess) {
  const double own_cost = FillSlacks(qp, point_);
  if (guess == nullptr) return own_cost < kNoBound;
  rollout_ = *guess;
  rollout_.stages[0].x = qp.x0;
  for (std::size_t i = 0; i + 1 < work_.size(); ++i) {
    const auto& stage = qp.stages[i];
    const auto& at = rollout_.stages[i];
    rollout_.stages[i + 1].x = stage.A * at.x + stage.B * at.u + stage.c;
  }
  const double cost = FillSlacks(qp, rollout_);
  if (cost < own_cost) point_ = rollout_;
  return std::min(cost, own_cost) < kNoBound;
}

template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::WriteBase(const Qp& qp) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const auto& work = work_[i];
    auto& at = point_.stages[i];
    at.x = work.base_x;
    at.u = work.base_u;
    at.pi = work.base_pi;
    std::fill_n(at.lambda.begin(), qp.stages[i].row_count, RowMultiplier{});
    std::fill_n(at.slack.begin(), qp.stages[i].row_count, 0.0);
  }
  WriteWeightlessSlacks(qp);
}

// Of the rows that cost nothing: whatever they need.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::WriteWeightlessSlacks(const Qp& qp) {
  if (!has_weightless_rows_) return;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    if (!row.weightless()) return;
    auto& at = point_.stages[i];
    const double value = detail::RowValue(row, at.x, at.u);
    at.slack[j] = std::max(0.0, detail::Violation(row.lo, row.hi, value));
  });
}

template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::WriteSolution(const Qp& qp) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const auto& work = work_[i];
    auto& at = point_.stages[i];
    at.x = work.base_x + work.x;
    at.u = work.base_u + work.u;
    at.pi = work.base_pi + work.pi;
    for (std::size_t j = 0; j < static_cast<std::size_t>(qp.stages[i].row_count); ++j) {
      at.lambda[j] = {.lo = work.rows[j].lo.lambda, .hi = work.rows[j].hi.lambda};
      at.slack[j] = work.rows[j].epsilon;
    }
  }
}

}  // namespace control
