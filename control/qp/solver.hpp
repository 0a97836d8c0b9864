// Solves an OcpQp by the cheapest of three methods that succeeds:
//   1. The unconstrained optimum, by one Riccati recursion (unconstrained.hpp). The answer if it violates no row.
//   2. A dual active-set method on the rows that matter, with sweeps of that recursion: O(N) per row
//      (active_set_method.hpp).
//   3. A primal-dual interior-point method: O(N) per iteration (interior_point_method.hpp). It is used if the active
//      set needs too many rows or loses its digits, or if a soft row is active on both of its bounds.
//
// Sources: C. V. Rao, S. J. Wright, J. B. Rawlings, Application of interior-point methods to model predictive control
// (1998), for the recursion and 3; D. Goldfarb, A. Idnani, A numerically stable dual method for solving strictly convex
// quadratic programs (1983), for 2; S. Mehrotra, On the implementation of a primal-dual interior point method (1992).
//
// Example:
//   OcpQpSolver<8, 2> solver(horizon);  // then solver.Solve(qp), or solver.Solve(qp, &warm_start)
//   if (solver.Solve(qp).status == SolverStatus::kSolved) use(solver.solution().stages[0].u);
#pragma once

#include "control/qp/active_set_method.hpp"
#include "control/qp/feasible_point.hpp"
#include "control/qp/interior_point_method.hpp"
#include "control/qp/point.hpp"
#include "control/qp/problem.hpp"
#include "control/qp/result.hpp"
#include "control/qp/settings.hpp"
#include "control/qp/shifted_bounds.hpp"
#include "control/qp/unconstrained.hpp"

namespace control {

template <int kNx, int kNu>
class OcpQpSolver {
 public:
  using Qp = OcpQp<kNx, kNu>;
  using Point = OcpQpPoint<kNx, kNu>;

  explicit OcpQpSolver(int horizon, const QpSettings& settings = {});  // horizon ≥ 1

  // `qp` and the warm start, which must not be solution() itself, must have the solver's horizon. The warm start shows
  // which rows to consider first and where the interior point starts. Does not allocate.
  //   kSolved            solution() satisfies the conditions of optimality to the tolerance (in deviations from the
  //                      unconstrained optimum, whose own round-off is added)
  //   kInfeasible        solution()'s multipliers prove that no point is feasible (ProvesInfeasible)
  //   kIterationLimit    neither within max_iterations and the time. solution() is the last iterate or the trajectory
  //                      of the warm start's inputs: the cheaper one that is feasible, else the last iterate. Slightly
  //                      contradictory rows whose inputs have no hard bounds end like this, too
  //   kNumericalFailure  the data are not finite or overflow, σ < 0, or a factorisation failed or was too inaccurate;
  //                      solution() is meaningless
  QpResult Solve(const Qp& qp, const Point* warm_start = nullptr, const TimeLeft* time_left = nullptr);

  [[nodiscard]] const Point& solution() const { return point_; }

 private:
  QpSettings settings_;
  Unconstrained<kNx, kNu> unconstrained_;
  ShiftedBounds<kNx, kNu> bounds_;
  ActiveSetMethod<kNx, kNu> active_set_;
  InteriorPointMethod<kNx, kNu> interior_point_;
  Point point_;
  Point roll_out_;  // trajectory of a warm start's inputs
};

template <int kNx, int kNu>
OcpQpSolver<kNx, kNu>::OcpQpSolver(int horizon, const QpSettings& settings)
    : settings_(settings),
      unconstrained_(horizon),
      bounds_(horizon),
      active_set_(horizon, settings),
      interior_point_(horizon, settings),
      point_(horizon),
      roll_out_(horizon) {}

template <int kNx, int kNu>
QpResult OcpQpSolver<kNx, kNu>::Solve(const Qp& qp, const Point* warm_start, const TimeLeft* time_left) {
  QpResult result;
  if (!HasFiniteData(qp) || !unconstrained_.Solve(qp, settings_.tolerance)) return result;
  const double violation = bounds_.Shift(qp, unconstrained_);
  if (!std::isfinite(violation)) return result;
  unconstrained_.Write(qp, point_);
  bounds_.FillFreeSlacks(qp, point_);
  if (violation == 0.0) {
    const double error = unconstrained_.stationarity_error();
    return {.status = SolverStatus::kSolved, .kkt_residual = error, .feasible = true};
  }
  result.method = QpMethod::kActiveSet;
  unconstrained_.CloseLoop(qp);
  const auto status = active_set_.Solve(qp, unconstrained_, bounds_, warm_start, time_left, point_, result);
  if (status) {
    result.status = *status;
  } else {
    result = interior_point_.Solve(qp, unconstrained_, bounds_, warm_start, time_left, point_);
  }
  result.feasible = result.status == SolverStatus::kSolved;
  if (result.status == SolverStatus::kIterationLimit)
    result.feasible = SettleForFeasible(qp, settings_.tolerance, warm_start, roll_out_, point_);
  return result;
}

extern template class OcpQpSolver<8, 2>;
extern template class OcpQpSolver<2, 1>;

}  // namespace control
