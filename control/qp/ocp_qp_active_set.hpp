// The dual active set of OcpQpSolver: definitions of the solver's SolveByActiveSet and what it calls.
//
// With H the Hessian of the problem without rows and G its rows, deviations from the base are −H⁻¹Gᵀλ, and the
// dual of the rows that matter is solved in dual_active_set.hpp. A column of M = G H⁻¹ Gᵀ is a row's response:
// one Riccati sweep with the row's normal as gradient. Rows are added, some at a time (their responses share a
// sweep), while the point of the last λ violates one; the rest of the rows are never looked at but for that.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "control/qp/ocp_qp_impl.hpp"
#include "control/qp/ocp_qp_rows.hpp"
#include "control/qp/ocp_qp_solver.hpp"

namespace control {

// Nothing if the interior point has to do it: too many rows, round-off, or a soft row that presses on both of its bounds,
// which lo > hi alone can bring about (the dual has one λ for the two).
template <int kNx, int kNu>
std::optional<SolverStatus> OcpQpSolver<kNx, kNu>::SolveByActiveSet(const Qp& qp, const Point* guess,
                                                                    const TimeLeft* time_left,
                                                                    QpResult& result) {
  constexpr int kMaxCorrections = 10;
  CloseLoop(qp);
  dual_.Clear();
  known_.clear();
  for (auto& work : work_) {
    work.x.setZero();
    work.u.setZero();
    work.pi.setZero();
    work.known.fill(-1);
  }
  bool violated = FindViolated(qp, guess);
  bool restarted = false;
  double stationarity = 0.0;
  const auto within_tolerance = [this](double gradient, double complementarity) {
    return row_error_ <= settings_.tolerance &&
           std::max({base_error_, gradient, complementarity}) <= tolerance_;
  };
  for (int corrections = 0; corrections <= kMaxCorrections;) {
    if (time_left != nullptr && !(*time_left)()) {
      WriteActiveSet(qp);
      return SolverStatus::kIterationLimit;
    }
    if (violated && !AddRows(qp)) return std::nullopt;
    const auto solved = dual_.Solve(RowTolerance());
    result.iterations += dual_.changes();
    if (solved == DualActiveSet::Result::kStuck) return std::nullopt;
    if (solved == DualActiveSet::Result::kInfeasible) {
      if (ProveByRay(qp)) return SolverStatus::kInfeasible;
      if (restarted) return std::nullopt;
      dual_.Restart();
      restarted = true;
      violated = false;
      continue;
    }
    MoveToMultipliers(qp);
    violated = FindViolated(qp, guess);
    if (violated) continue;
    stationarity = StationarityError(qp);
    result.kkt_residual = std::max({base_error_, stationarity, row_error_, complementarity_error_});
    if (within_tolerance(stationarity, complementarity_error_)) {
      WriteActiveSet(qp);
      return SolverStatus::kSolved;
    }
    ++corrections;
    CorrectValues(qp);
  }
  // Rows that nearly depend on each other can have a λ whose round-off is above the tolerance.
  double largest_lambda = 1.0;
  for (int a = 0; a < dual_.size(); ++a) largest_lambda = std::max(largest_lambda, std::abs(dual_.lambda(a)));
  if (!within_tolerance(stationarity - kRoundOff * largest_lambda, distance_error_)) return std::nullopt;
  WriteActiveSet(qp);
  return SolverStatus::kSolved;
}

// Calls visit(row, its stage, its index there, its index in the dual) for every row that the dual knows.
template <int kNx, int kNu>
template <typename Visit>
void OcpQpSolver<kNx, kNu>::ForEachKnown(const Qp& qp, Visit&& visit) const {
  for (std::size_t a = 0; a < known_.size(); ++a) {
    const RowPlace& place = known_[a];
    visit(qp.stages[place.stage].rows[place.row], place.stage, place.row, static_cast<int>(a));
  }
}

// The slack of a soft row with this multiplier and this violation.
template <int kNx, int kNu>
double OcpQpSolver<kNx, kNu>::SlackOf(const OcpQpRow<kNx, kNu>& row, double lambda, double violation) {
  if (!row.soft()) return 0.0;
  if (row.rho > 0.0) return std::max(0.0, (std::abs(lambda) - row.sigma) / row.rho);
  return std::abs(lambda) < row.sigma ? 0.0 : std::max(0.0, violation);
}

// Of the rows that are violated at x, u and not known yet, the kBatch that are violated most into candidates_, where a
// row that presses in the guess counts the more. True if there are any.
template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::FindViolated(const Qp& qp, const Point* guess) {
  // A guess of the step before names the right rows mostly; one of long ago misleads. So it weighs, but not all.
  constexpr double kTrust = 2.0;
  const double tolerance = RowTolerance();
  const auto offer = [this](const RowPlace& place) {  // keeps candidates_ sorted
    if (candidates_.size() < kBatch)
      candidates_.push_back(place);
    else if (candidates_.back().priority >= place.priority)
      return;
    std::size_t k = candidates_.size() - 1;
    for (; k > 0 && candidates_[k - 1].priority < place.priority; --k) candidates_[k] = candidates_[k - 1];
    candidates_[k] = place;
  };
  candidates_.clear();
  row_error_ = complementarity_error_ = distance_error_ = 0.0;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    const auto& work = work_[i];
    const double value = detail::RowValue(row, work.x, work.u);
    const double violation = detail::Violation(work.lo[j], work.hi[j], value);
    if (work.known[j] >= 0) {
      const double lambda = dual_.lambda(work.known[j]);
      const double slack = SlackOf(row, lambda, violation);
      if (!(violation <= slack)) detail::Raise(row_error_, violation - slack);
      if (lambda == 0.0) return;
      const double beyond =
          lambda > 0.0 ? value - work.hi[j] : work.lo[j] - value;  // the side that λ presses on
      const double round_off = kRoundOff * std::max(1.0, std::abs(value));
      const double distance = std::max(std::abs(beyond - slack) - round_off, 0.0);
      detail::Raise(complementarity_error_, lambda * distance);
      detail::Raise(distance_error_, std::min(std::abs(lambda), 1.0) * distance);
    } else if (!(violation <= tolerance) && !row.weightless()) {
      detail::Raise(row_error_, violation);
      const bool pressed = guess != nullptr && guess->stages[i].lambda[j].Presses();
      offer({.stage = i, .row = j, .priority = pressed ? kTrust * violation : violation});
    }
  });
  return !candidates_.empty();
}

// The candidates into the dual, with their columns of M. False if it is full.
template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::AddRows(const Qp& qp) {
  const int first = dual_.size(), count = static_cast<int>(candidates_.size());
  if (first + count > settings_.max_known_rows) return false;
  std::size_t last = 0;
  for (const RowPlace& place : candidates_) last = std::max(last, place.stage);
  detail::ClearGradients(last, responses_);
  for (int b = 0; b < count; ++b) {
    const RowPlace& place = candidates_[static_cast<std::size_t>(b)];
    const auto& row = qp.stages[place.stage].rows[place.row];
    auto& work = work_[place.stage];
    responses_[place.stage].p.col(b) += row.C;
    responses_[place.stage].k.col(b) += row.D;
    work.known[place.row] = dual_.Add(work.lo[place.row], work.hi[place.row], row.rho, row.sigma, 0.0);
    known_.push_back(place);
  }
  detail::SweepRiccati(qp, riccati_, last, responses_);
  ForEachKnown(qp, [&](const auto& row, std::size_t i, std::size_t, int a) {
    const auto& response = responses_[i];
    Eigen::Matrix<double, 1, kBatch> value;
    if (row.unit >= kNx) {
      value = response.du.row(row.unit - kNx);
    } else if (row.unit >= 0) {
      value = response.dx.row(row.unit);
    } else {
      value =
          detail::Product(row.C.transpose(), response.dx) + detail::Product(row.D.transpose(), response.du);
    }
    for (int b = 0; b < count; ++b) dual_.SetM(a, first + b, -value[b]);
  });
  return true;
}

// x, u, π of the dual's λ.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::MoveToMultipliers(const Qp& qp) {
  const std::size_t N = work_.size() - 1;
  detail::ClearGradients(N, sweep_);
  ForEachKnown(qp, [&](const auto& row, std::size_t i, std::size_t, int a) {
    if (dual_.lambda(a) != 0.0) detail::AddRowGradient(row, dual_.lambda(a), sweep_[i].p, sweep_[i].k);
  });
  detail::SweepRiccati(qp, riccati_, N, sweep_);
  for (std::size_t i = 0; i < work_.size(); ++i) {
    auto& work = work_[i];
    work.x = sweep_[i].dx;
    work.u = sweep_[i].du;
  }
}

// Tells the dual the rows' values at x, u, which its M has but to round-off.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::CorrectValues(const Qp& qp) {
  ForEachKnown(qp, [&](const auto& row, std::size_t i, std::size_t, int a) {
    dual_.Correct(a, detail::RowValue(row, work_[i].x, work_[i].u));
  });
}

// The largest entry of the Lagrangian's gradient at x, u, λ. Computes π.
template <int kNx, int kNu>
double OcpQpSolver<kNx, kNu>::StationarityError(const Qp& qp) {
  const std::size_t N = work_.size() - 1;
  for (std::size_t i = 0; i <= N; ++i) {
    auto& work = work_[i];
    const auto& stage = qp.stages[i];
    work.pi = sweep_[i].p + detail::Product(riccati_[i].P, work.x);
    work.r_x = stage.Q.cwiseProduct(work.x) - work.pi;
    work.r_u = stage.R.cwiseProduct(work.u);
  }
  ForEachKnown(qp, [&](const auto& row, std::size_t i, std::size_t, int a) {
    detail::AddRowGradient(row, dual_.lambda(a), work_[i].r_x, work_[i].r_u);
  });
  return LargestGradient(
      qp, [this](std::size_t i) -> const VectorX& { return work_[i].r_x; },
      [this](std::size_t i) -> const VectorU& { return work_[i].r_u; },
      [this](std::size_t i) -> const VectorX& { return work_[i].pi; });
}

template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::ProveByRay(const Qp& qp) {
  ForEachKnown(qp, [&](const auto&, std::size_t i, std::size_t j, int a) {
    point_.stages[i].lambda[j] = RowMultiplier::OfDifference(dual_.ray(a));
  });
  return ProvesInfeasible(qp, point_);
}

template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::WriteActiveSet(const Qp& qp) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const auto& work = work_[i];
    auto& at = point_.stages[i];
    at.x += work.x;
    at.u += work.u;
    at.pi += work.pi;
  }
  WriteWeightlessSlacks(qp);
  ForEachKnown(qp, [&](const auto& row, std::size_t i, std::size_t j, int a) {
    const auto& work = work_[i];
    auto& at = point_.stages[i];
    const double lambda = dual_.lambda(a);
    at.lambda[j] = RowMultiplier::OfDifference(lambda);
    if (!row.soft()) return;
    const double value = detail::RowValue(row, work.x, work.u);
    at.slack[j] = SlackOf(row, lambda, detail::Violation(work.lo[j], work.hi[j], value));
  });
}

}  // namespace control
