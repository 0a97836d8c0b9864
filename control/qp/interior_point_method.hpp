// The interior-point method of OcpQpSolver: primal-dual, with Mehrotra's predictor and corrector. The Newton system as
// reduced by barrier_row.hpp is solved by the Riccati recursion of riccati.hpp, where g_x, g_u are the gradients of the
// Lagrangian at the iterate plus Σ γ C, Σ γ D of the rows.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "control/qp/barrier_row.hpp"
#include "control/qp/kkt.hpp"
#include "control/qp/largest_entry.hpp"
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
class InteriorPointMethod {
 public:
  using Qp = OcpQp<kNx, kNu>;
  using Point = OcpQpPoint<kNx, kNu>;
  using Optimum = Unconstrained<kNx, kNu>;
  using Bounds = ShiftedBounds<kNx, kNu>;

  InteriorPointMethod(int horizon, const QpSettings& settings)
      : settings_(settings),
        work_(static_cast<std::size_t>(horizon) + 1),
        riccati_(work_.size()),
        sweep_(work_.size()) {}

  // Starts from the warm start (may be null) if that is near enough. Writes the last iterate to `point`, except after
  // kNumericalFailure. Does not allocate.
  [[nodiscard]] QpResult Solve(const Qp& qp, const Optimum& optimum, const Bounds& bounds,
                               const Point* warm_start, const TimeLeft* time_left, Point& point);

  // The parts of an iteration, in this order, public for benchmarks.
  void BeginRows(const Qp& qp, const Bounds& bounds) {
    sides_ = 0;
    detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
      sides_ += work_[i].rows[j].Begin(row, bounds[i].lo[j], bounds[i].hi[j]);
    });
  }
  void StartCold(const Qp& qp);
  [[nodiscard]] double Residuals(const Qp& qp);
  // False if a pivot is not positive.
  [[nodiscard]] bool Factorise(const Qp& qp) {
    detail::ForEachRow(
        qp, [&](const auto& row, std::size_t i, std::size_t j) { work_[i].rows[j].ComputeCurvature(row); });
    return detail::FactoriseRiccati(
        qp, [&](std::size_t i) { return static_cast<std::size_t>(qp.stages[i].row_count); },
        [&](std::size_t i, std::size_t j) { return work_[i].rows[j].w; }, riccati_);
  }
  // Computes the Newton step towards λ t = target, optionally with Mehrotra's second-order term of the previous step.
  void Step(const Qp& qp, double target, bool second_order);

 private:
  using VectorX = Eigen::Matrix<double, kNx, 1>;
  using VectorU = Eigen::Matrix<double, kNu, 1>;
  // Deviations from the unconstrained optimum, and the gradient r of the Lagrangian.
  struct StageWork {
    VectorX x, pi, r_x;
    VectorU u, r_u;
    std::array<BarrierRow, kMaxRows> rows;
  };

  [[nodiscard]] bool StartFrom(const Qp& qp, const Optimum& optimum, const Point& warm_start);
  // The largest α ≤ 1 after which every t and λ is at least the fraction 1 − keep of its value before.
  [[nodiscard]] double StepLength(double keep) const { return std::min(1.0, keep * step_.longest); }
  // μ after a step of length α.
  [[nodiscard]] double ComplementarityAfter(double alpha) const {
    return mu_ + alpha * (step_.first_order + alpha * step_.second_order) / std::max(sides_, 1);
  }
  void Move(const Qp& qp, double alpha);
  void Write(const Qp& qp, const Optimum& optimum, Point& point) const;

  QpSettings settings_;
  std::vector<StageWork> work_;
  std::vector<detail::RiccatiStage<kNx, kNu>> riccati_;
  std::vector<detail::SweepStage<kNx, kNu, 1>> sweep_;
  // At the iterate: the largest |distance − t|; the largest λ times its row's distance; the same with λ capped at 1.
  double row_error_ = 0.0, complementarity_error_ = 0.0, distance_error_ = 0.0;
  double mu_ = 0.0;  // mean complementarity
  BarrierStep step_;
  int sides_ = 0;  // number of finite bounds, including those of slacks
};

template <int kNx, int kNu>
QpResult InteriorPointMethod<kNx, kNu>::Solve(const Qp& qp, const Optimum& optimum, const Bounds& bounds,
                                              const Point* warm_start, const TimeLeft* time_left,
                                              Point& point) {
  QpResult result{.method = QpMethod::kInteriorPoint};
  const double tolerance = optimum.tolerance();
  constexpr double kWild = 1e9;  // a warm start with a residual above this is not worth using
  BeginRows(qp, bounds);
  const bool warm = warm_start != nullptr && StartFrom(qp, optimum, *warm_start);
  if (!warm || !(Residuals(qp) <= kWild)) StartCold(qp);
  constexpr double kShort = 0.9;
  double alpha = 1.0;
  double infeasibility = 1.0;  // share left of the initial linear residuals
  for (;; ++result.iterations) {
    const double linear = Residuals(qp);
    result.kkt_residual = std::max(linear, complementarity_error_);
    if (!std::isfinite(result.kkt_residual)) return result;
    const bool at_limit = result.iterations == settings_.max_iterations;
    // As in the active set, some λ can be so large that their round-off exceeds the tolerance.
    const double largest = std::max(linear, at_limit ? distance_error_ : complementarity_error_);
    if (largest <= tolerance && row_error_ <= settings_.tolerance) {
      result.status = SolverStatus::kSolved;
      break;
    }
    // Multipliers that prove infeasibility grow while steps are short.
    if (row_error_ > tolerance && result.iterations >= 3 && alpha < kShort) {
      Write(qp, optimum, point);
      if (ProvesInfeasible(qp, point)) {
        result.status = SolverStatus::kInfeasible;
        return result;
      }
    }
    if (at_limit || (time_left != nullptr && !(*time_left)())) {
      result.status = SolverStatus::kIterationLimit;
      break;
    }
    if (!Factorise(qp)) return result;
    // The predictor aims at complementarity zero. Its length determines how much centring the corrector needs.
    Step(qp, 0.0, false);
    const double ratio = ComplementarityAfter(StepLength(1.0)) / mu_;
    // A μ far below the tolerance would cost digits (t as small as round-off) and gain nothing.
    const double target = std::max(ratio * ratio * ratio * mu_, 1e-2 * tolerance);
    Step(qp, target, true);
    const double keep = std::clamp(1.0 - mu_, 0.995, 1.0 - 1e-8);  // 1 would allow t = 0
    alpha = StepLength(keep);
    // The second-order term can make the iterates cycle (C. Cartis, Some disadvantages of a Mehrotra-type primal-dual
    // corrector interior point algorithm for linear programming, 2009). A cycle raises μ somewhere. Once the linear
    // equations hold, a sufficiently short step without that term lowers μ.
    if (infeasibility <= 1e-2 && ComplementarityAfter(alpha) > mu_) {
      Step(qp, 0.3 * mu_, false);
      alpha = StepLength(keep);
      for (int halvings = 6; halvings > 0 && ComplementarityAfter(alpha) > mu_; --halvings) alpha *= 0.5;
    }
    infeasibility *= 1.0 - alpha;
    Move(qp, alpha);
  }
  Write(qp, optimum, point);
  return result;
}

// Starts from the unconstrained optimum. If that violates a row with σ > 0, λ_lo + λ_hi may have to rise to σ: μ then
// starts larger, since steps are short while infeasibility is large compared with μ.
template <int kNx, int kNu>
void InteriorPointMethod<kNx, kNu>::StartCold(const Qp& qp) {
  constexpr double kShare = 0.1;  // t starts at this share of the width, where λ = σ needs μ = kShare σ
  constexpr double kMostMu = 100.0;
  double mu = 1.0;
  for (StageWork& work : work_) {
    work.x.setZero();
    work.u.setZero();
    work.pi.setZero();
  }
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    const BarrierRow& at = work_[i].rows[j];
    const bool violated = at.lo.bound > 0.0 || at.hi.bound < 0.0;
    if (row.exact() && violated) mu = std::clamp(kShare * row.sigma, mu, kMostMu);
  });
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    const double value = detail::RowValue(row, work_[i].x, work_[i].u);
    work_[i].rows[j].Start(row, value, kShare, mu, {});
  });
}

// Starts from the warm start's inputs and multipliers, kept off the boundary so that a row may still become active or
// inactive. False if they violate a row by more than its slack plus kMaxViolation: from far outside, a cold start takes
// fewer steps.
template <int kNx, int kNu>
bool InteriorPointMethod<kNx, kNu>::StartFrom(const Qp& qp, const Optimum& optimum, const Point& warm_start) {
  constexpr double kStartMu = 0.1;
  constexpr double kMaxViolation = 1e-2;
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const auto& start = warm_start.stages[i];
    StageWork& work = work_[i];
    work.u = start.u - optimum[i].u;
    work.pi = start.pi - optimum[i].pi;
    if (i + 1 < work_.size()) work_[i + 1].x = qp.stages[i].A * work.x + qp.stages[i].B * work.u;
    for (std::size_t j = 0; j < static_cast<std::size_t>(qp.stages[i].row_count); ++j) {
      const auto& row = qp.stages[i].rows[j];
      BarrierRow& at = work.rows[j];
      const double value = detail::RowValue(row, work.x, work.u);
      const double violation = detail::Violation(at.lo.bound, at.hi.bound, value);
      if (!(violation - start.slack[j] <= kMaxViolation)) return false;
      at.Start(row, value, 0.02, kStartMu, start.lambda[j]);
    }
  }
  return true;
}

// Computes the residuals of all equations except λ t = 0, μ, and the errors of the rows. Returns the largest residual.
template <int kNx, int kNu>
double InteriorPointMethod<kNx, kNu>::Residuals(const Qp& qp) {
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
      BarrierRow& at = work.rows[j];
      const double value = detail::RowValue(row, work.x, work.u);
      detail::AddRowGradient(row, at.hi.lambda - at.lo.lambda, work.r_x, work.r_u);
      const auto side = [&](BarrierSide& s, double distance) {
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
void InteriorPointMethod<kNx, kNu>::Step(const Qp& qp, double target, bool second_order) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const auto& stage = qp.stages[i];
    StageWork& work = work_[i];
    auto& sweep = sweep_[i];
    sweep.p = work.r_x;
    sweep.k = work.r_u;
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      const double gradient = work.rows[j].Gradient(target, second_order);
      detail::AddRowGradient(stage.rows[j], gradient, sweep.p, sweep.k);
    }
  }
  detail::SweepRiccati(qp, riccati_, work_.size() - 1, sweep_);
  BarrierStep step;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    work_[i].rows[j].ComputeStep(detail::RowValue(row, sweep_[i].dx, sweep_[i].du), step);
  });
  step_ = step;
}

template <int kNx, int kNu>
void InteriorPointMethod<kNx, kNu>::Move(const Qp& qp, double alpha) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    StageWork& work = work_[i];
    const auto& sweep = sweep_[i];
    work.x += alpha * sweep.dx;
    work.u += alpha * sweep.du;
    if (i > 0) work.pi += alpha * (sweep.p + detail::Product(riccati_[i].P, sweep.dx));
  }
  detail::ForEachRow(qp, [&](const auto&, std::size_t i, std::size_t j) { work_[i].rows[j].Move(alpha); });
}

template <int kNx, int kNu>
void InteriorPointMethod<kNx, kNu>::Write(const Qp& qp, const Optimum& optimum, Point& point) const {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const StageWork& work = work_[i];
    auto& at = point.stages[i];
    at.x = optimum[i].x + work.x;
    at.u = optimum[i].u + work.u;
    at.pi = optimum[i].pi + work.pi;
    for (std::size_t j = 0; j < static_cast<std::size_t>(qp.stages[i].row_count); ++j) {
      at.lambda[j] = {.lo = work.rows[j].lo.lambda, .hi = work.rows[j].hi.lambda};
      at.slack[j] = work.rows[j].epsilon;
    }
  }
}

}  // namespace control
