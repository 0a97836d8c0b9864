// The dual active-set method of OcpQpSolver. With the Hessian H of the problem without rows, and G its rows, deviations
// from the unconstrained optimum are −H⁻¹Gᵀλ, and the dual of the rows in the working set is solved in
// dual_active_set.hpp. A column of M = G H⁻¹ Gᵀ is the response to a row: one Riccati sweep with the row's normal as
// gradient. Violated rows join the working set a few at a time, so that their responses share a sweep, until the point
// violates no row. All other rows are only checked for violation.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "control/qp/dual_active_set.hpp"
#include "control/qp/kkt.hpp"
#include "control/qp/largest_entry.hpp"
#include "control/qp/most_violated.hpp"
#include "control/qp/point.hpp"
#include "control/qp/problem.hpp"
#include "control/qp/result.hpp"
#include "control/qp/riccati.hpp"
#include "control/qp/rows.hpp"
#include "control/qp/settings.hpp"
#include "control/qp/shifted_bounds.hpp"
#include "control/qp/unconstrained.hpp"

namespace control {

template <int kNx, int kNu>
class ActiveSetMethod {
 public:
  using Qp = OcpQp<kNx, kNu>;
  using Point = OcpQpPoint<kNx, kNu>;
  using Optimum = Unconstrained<kNx, kNu>;
  using Bounds = ShiftedBounds<kNx, kNu>;

  ActiveSetMethod(int horizon, const QpSettings& settings)
      : settings_(settings),
        work_(static_cast<std::size_t>(horizon) + 1),
        sweep_(work_.size()),
        responses_(work_.size()),
        dual_(settings.max_working_set) {
    working_set_.reserve(static_cast<std::size_t>(settings.max_working_set));
  }

  // Requires that `optimum` is solved, its loop closed, and `point` written from it. The rows that are active in the
  // warm start (may be null) are preferred. Fills in the result's iterations and KKT residual, and the point. Returns
  // nullopt if another method has to solve the problem, because of too many rows or round-off, or because a soft row is
  // active on both of its bounds (possible only if lo > hi; the dual has one λ for the two). Does not allocate.
  [[nodiscard]] std::optional<SolverStatus> Solve(const Qp& qp, const Optimum& optimum, const Bounds& bounds,
                                                  const Point* warm_start, const TimeLeft* time_left,
                                                  Point& point, QpResult& result);

  // Scans for violated rows at the point of the last solve; public for benchmarks. True if there are any.
  bool FindViolated(const Qp& qp, const Bounds& bounds, const Point* warm_start);

 private:
  static constexpr int kBatch = 4;  // rows whose responses share a sweep

  using VectorX = Eigen::Matrix<double, kNx, 1>;
  using VectorU = Eigen::Matrix<double, kNu, 1>;
  // Deviations from the unconstrained optimum, and the gradient r of the Lagrangian.
  struct StageWork {
    VectorX x, pi, r_x;
    VectorU u, r_u;
    std::array<int, kMaxRows> working;  // the row's index in the dual; −1: not in the working set
  };

  [[nodiscard]] double RowTolerance() const { return 0.1 * settings_.tolerance; }
  // Calls visit(row, its stage, its index there, its index in the dual) for every row of the working set.
  template <typename Visit>
  void ForEachWorking(const Qp& qp, Visit&& visit) const {
    for (std::size_t a = 0; a < working_set_.size(); ++a) {
      const RowPlace& place = working_set_[a];
      visit(qp.stages[place.stage].rows[place.row], place.stage, place.row, static_cast<int>(a));
    }
  }
  void Clear() {
    dual_.Clear();
    working_set_.clear();
    for (StageWork& work : work_) {
      work.x.setZero();
      work.u.setZero();
      work.pi.setZero();
      work.working.fill(-1);
    }
  }
  bool AddRows(const Qp& qp, const Optimum& optimum, const Bounds& bounds);
  void MoveToMultipliers(const Qp& qp, const Optimum& optimum);
  void CorrectValues(const Qp& qp);
  [[nodiscard]] double StationarityError(const Qp& qp, const Optimum& optimum);
  [[nodiscard]] bool ProveByRay(const Qp& qp, Point& point) const {
    ForEachWorking(qp, [&](const auto&, std::size_t i, std::size_t j, int a) {
      point.stages[i].lambda[j] = RowMultiplier::FromDifference(dual_.ray(a));
    });
    return ProvesInfeasible(qp, point);
  }
  void Write(const Qp& qp, const Bounds& bounds, Point& point) const;

  QpSettings settings_;
  std::vector<StageWork> work_;
  std::vector<detail::SweepStage<kNx, kNu, 1>> sweep_;
  std::vector<detail::SweepStage<kNx, kNu, kBatch>> responses_;
  DualActiveSet dual_;
  std::vector<RowPlace> working_set_;  // the dual's rows
  MostViolated<kBatch> candidates_;    // the next rows to be added
  // At x, u, λ: the largest violation of a row; the largest λ times its row's distance; the same with λ capped at 1.
  double row_error_ = 0.0, complementarity_error_ = 0.0, distance_error_ = 0.0;
};

template <int kNx, int kNu>
std::optional<SolverStatus> ActiveSetMethod<kNx, kNu>::Solve(const Qp& qp, const Optimum& optimum,
                                                             const Bounds& bounds, const Point* warm_start,
                                                             const TimeLeft* time_left, Point& point,
                                                             QpResult& result) {
  constexpr int kMaxCorrections = 10;
  Clear();
  bool violated = FindViolated(qp, bounds, warm_start);
  bool restarted = false;
  double stationarity = 0.0;
  const double optimum_error = optimum.stationarity_error();
  const auto within_tolerance = [&](double gradient, double complementarity) {
    return row_error_ <= settings_.tolerance &&
           std::max({optimum_error, gradient, complementarity}) <= optimum.tolerance();
  };
  for (int corrections = 0; corrections <= kMaxCorrections;) {
    if (time_left != nullptr && !(*time_left)()) {
      Write(qp, bounds, point);
      return SolverStatus::kIterationLimit;
    }
    if (violated && !AddRows(qp, optimum, bounds)) return std::nullopt;
    const auto solved = dual_.Solve(RowTolerance());
    result.iterations += dual_.changes();
    if (solved == DualActiveSet::Result::kStuck) return std::nullopt;
    if (solved == DualActiveSet::Result::kInfeasible) {
      if (ProveByRay(qp, point)) return SolverStatus::kInfeasible;
      if (restarted) return std::nullopt;
      dual_.Restart();
      restarted = true;
      violated = false;
      continue;
    }
    MoveToMultipliers(qp, optimum);
    violated = FindViolated(qp, bounds, warm_start);
    if (violated) continue;
    stationarity = StationarityError(qp, optimum);
    result.kkt_residual = std::max({optimum_error, stationarity, row_error_, complementarity_error_});
    if (within_tolerance(stationarity, complementarity_error_)) {
      Write(qp, bounds, point);
      return SolverStatus::kSolved;
    }
    ++corrections;
    CorrectValues(qp);
  }
  // Nearly dependent rows can have multipliers whose round-off exceeds the tolerance.
  double largest_lambda = 1.0;
  for (int a = 0; a < dual_.size(); ++a) largest_lambda = std::max(largest_lambda, std::abs(dual_.lambda(a)));
  if (!within_tolerance(stationarity - kQpRoundOff * largest_lambda, distance_error_)) return std::nullopt;
  Write(qp, bounds, point);
  return SolverStatus::kSolved;
}

// Makes the most violated rows outside the working set the candidates, preferably those that are active in the warm
// start. Computes the errors of the rows. True if there are candidates.
template <int kNx, int kNu>
bool ActiveSetMethod<kNx, kNu>::FindViolated(const Qp& qp, const Bounds& bounds, const Point* warm_start) {
  // A warm start from the previous step mostly has the right rows active, an older one misleads: it only adds priority.
  constexpr double kTrust = 2.0;
  const double tolerance = RowTolerance();
  candidates_.Clear();
  row_error_ = complementarity_error_ = distance_error_ = 0.0;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    const auto& work = work_[i];
    const auto& at = bounds[i];
    const double value = detail::RowValue(row, work.x, work.u);
    const double violation = detail::Violation(at.lo[j], at.hi[j], value);
    if (work.working[j] >= 0) {
      const double lambda = dual_.lambda(work.working[j]);
      const double slack = detail::SlackOf(row, lambda, violation);
      if (!(violation <= slack)) detail::Raise(row_error_, violation - slack);
      if (lambda == 0.0) return;
      const double beyond =
          lambda > 0.0 ? value - at.hi[j] : at.lo[j] - value;  // distance beyond the bound of λ
      const double round_off = kQpRoundOff * std::max(1.0, std::abs(value));
      const double distance = std::max(std::abs(beyond - slack) - round_off, 0.0);
      detail::Raise(complementarity_error_, lambda * distance);
      detail::Raise(distance_error_, std::min(std::abs(lambda), 1.0) * distance);
    } else if (!(violation <= tolerance) && !row.has_zero_penalty()) {
      detail::Raise(row_error_, violation);
      const bool active = warm_start != nullptr && warm_start->stages[i].lambda[j].IsActive();
      candidates_.Offer({.stage = i, .row = j, .priority = active ? kTrust * violation : violation});
    }
  });
  return candidates_.size() > 0;
}

// Adds the candidates to the dual, with their columns of M. False if the dual is full.
template <int kNx, int kNu>
bool ActiveSetMethod<kNx, kNu>::AddRows(const Qp& qp, const Optimum& optimum, const Bounds& bounds) {
  const int first = dual_.size(), count = candidates_.size();
  if (first + count > settings_.max_working_set) return false;
  std::size_t last = 0;
  for (const RowPlace& place : candidates_.rows()) last = std::max(last, place.stage);
  detail::ClearGradients(last, responses_);
  for (int b = 0; b < count; ++b) {
    const RowPlace& place = candidates_.rows()[static_cast<std::size_t>(b)];
    const auto& row = qp.stages[place.stage].rows[place.row];
    const auto& at = bounds[place.stage];
    responses_[place.stage].p.col(b) += row.C;
    responses_[place.stage].k.col(b) += row.D;
    work_[place.stage].working[place.row] =
        dual_.Add(at.lo[place.row], at.hi[place.row], row.rho, row.sigma, 0.0);
    working_set_.push_back(place);
  }
  detail::SweepRiccati(qp, optimum.riccati(), last, responses_);
  ForEachWorking(qp, [&](const auto& row, std::size_t i, std::size_t, int a) {
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

// Computes x, u for the dual's λ.
template <int kNx, int kNu>
void ActiveSetMethod<kNx, kNu>::MoveToMultipliers(const Qp& qp, const Optimum& optimum) {
  const std::size_t N = work_.size() - 1;
  detail::ClearGradients(N, sweep_);
  ForEachWorking(qp, [&](const auto& row, std::size_t i, std::size_t, int a) {
    if (dual_.lambda(a) != 0.0) detail::AddRowGradient(row, dual_.lambda(a), sweep_[i].p, sweep_[i].k);
  });
  detail::SweepRiccati(qp, optimum.riccati(), N, sweep_);
  for (std::size_t i = 0; i < work_.size(); ++i) {
    auto& work = work_[i];
    work.x = sweep_[i].dx;
    work.u = sweep_[i].du;
  }
}

// Replaces the dual's values of the rows by those at x, u; its M yields them only up to round-off.
template <int kNx, int kNu>
void ActiveSetMethod<kNx, kNu>::CorrectValues(const Qp& qp) {
  ForEachWorking(qp, [&](const auto& row, std::size_t i, std::size_t, int a) {
    dual_.Correct(a, detail::RowValue(row, work_[i].x, work_[i].u));
  });
}

// Returns the largest entry of the Lagrangian's gradient at x, u, λ. Also computes π.
template <int kNx, int kNu>
double ActiveSetMethod<kNx, kNu>::StationarityError(const Qp& qp, const Optimum& optimum) {
  const std::size_t N = work_.size() - 1;
  for (std::size_t i = 0; i <= N; ++i) {
    auto& work = work_[i];
    const auto& stage = qp.stages[i];
    work.pi = sweep_[i].p + detail::Product(optimum.riccati()[i].P, work.x);
    work.r_x = stage.Q.cwiseProduct(work.x) - work.pi;
    work.r_u = stage.R.cwiseProduct(work.u);
  }
  ForEachWorking(qp, [&](const auto& row, std::size_t i, std::size_t, int a) {
    detail::AddRowGradient(row, dual_.lambda(a), work_[i].r_x, work_[i].r_u);
  });
  return detail::LargestGradient(
      qp, optimum.riccati(), [this](std::size_t i) -> const VectorX& { return work_[i].r_x; },
      [this](std::size_t i) -> const VectorU& { return work_[i].r_u; },
      [this](std::size_t i) -> const VectorX& { return work_[i].pi; });
}

template <int kNx, int kNu>
void ActiveSetMethod<kNx, kNu>::Write(const Qp& qp, const Bounds& bounds, Point& point) const {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const auto& work = work_[i];
    auto& at = point.stages[i];
    at.x += work.x;
    at.u += work.u;
    at.pi += work.pi;
  }
  bounds.FillFreeSlacks(qp, point);
  ForEachWorking(qp, [&](const auto& row, std::size_t i, std::size_t j, int a) {
    const auto& work = work_[i];
    auto& at = point.stages[i];
    const double lambda = dual_.lambda(a);
    at.lambda[j] = RowMultiplier::FromDifference(lambda);
    if (!row.soft()) return;
    const double value = detail::RowValue(row, work.x, work.u);
    at.slack[j] = detail::SlackOf(row, lambda, detail::Violation(bounds[i].lo[j], bounds[i].hi[j], value));
  });
}

}  // namespace control
