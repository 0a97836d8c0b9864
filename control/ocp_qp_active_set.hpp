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

#include "control/ocp_qp_impl.hpp"
#include "control/ocp_qp_rows.hpp"
#include "control/ocp_qp_solver.hpp"

namespace control {

// Nothing if the interior point has to do it: too many rows, or round-off.
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
  // What needs few rows is done before a guess, which may be a bad one, has cost anything.
  bool violated = FindViolated(qp, nullptr);
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
      if (!ProveByRay(qp)) return std::nullopt;
      return SolverStatus::kInfeasible;
    }
    MoveToMultipliers(qp);
    violated = FindViolated(qp, guess);
    if (violated) continue;
    result.kkt_residual = std::max({base_error_, StationarityError(qp), row_error_});
    if (result.kkt_residual <= tolerance_) {
      WriteActiveSet(qp);
      return SolverStatus::kSolved;
    }
    ++corrections;  // FindViolated has told the dual the rows' true values
  }
  return std::nullopt;
}

// The slack of a soft row with this multiplier and this violation.
template <int kNx, int kNu>
double OcpQpSolver<kNx, kNu>::SlackOf(const OcpQpRow<kNx, kNu>& row, double lambda, double violation) {
  if (!row.soft()) return 0.0;
  return std::max(0.0, row.rho > 0.0 ? (std::abs(lambda) - row.sigma) / row.rho : violation);
}

// Of the rows that are violated at x, u and not known yet: kBatch that press in the guess, and of the others the
// kBatch that are violated most, into candidates_. True if there are any. Known rows are corrected in the dual.
template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::FindViolated(const Qp& qp, const Point* guess) {
  const double tolerance = RowTolerance();
  std::array<RowPlace, kBatch> worst{};
  std::size_t count = 0;
  const auto offer = [&](const RowPlace& place) {  // keeps `worst` sorted
    std::size_t k = count < worst.size() ? count++ : worst.size() - 1;
    if (k == worst.size() - 1 && worst[k].violation >= place.violation) return;
    for (; k > 0 && worst[k - 1].violation < place.violation; --k) worst[k] = worst[k - 1];
    worst[k] = place;
  };
  candidates_.clear();
  row_error_ = 0.0;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    const auto& work = work_[i];
    const double value = detail::RowValue(row, work.x, work.u);
    const double violation = detail::Violation(work.lo[j], work.hi[j], value);
    if (work.known[j] >= 0) {
      dual_.Correct(work.known[j], value);
      const double lambda = dual_.lambda(work.known[j]);
      const double error = violation - SlackOf(row, lambda, violation);
      const double round_off = kRoundOff * std::max(1.0, std::abs(value));
      row_error_ = std::max({row_error_, error, std::abs(lambda) * (std::abs(error) - round_off)});
    } else if (violation > tolerance && !row.weightless()) {
      row_error_ = std::max(row_error_, violation);
      const RowPlace place{.stage = i, .row = j, .violation = violation};
      if (guess != nullptr && guess->stages[i].lambda[j].Presses() && candidates_.size() < kBatch)
        candidates_.push_back(place);
      else
        offer(place);
    }
  });
  candidates_.insert(candidates_.end(), worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(count));
  return !candidates_.empty();
}

// The candidates into the dual, with their columns of M. False if it is full.
template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::AddRows(const Qp& qp) {
  if (dual_.size() + static_cast<int>(candidates_.size()) > settings_.max_known_rows) return false;
  for (std::size_t begin = 0; begin < candidates_.size(); begin += kBatch) {
    const std::size_t count = std::min(candidates_.size() - begin, static_cast<std::size_t>(kBatch));
    std::size_t last = 0;
    for (std::size_t b = 0; b < count; ++b) last = std::max(last, candidates_[begin + b].stage);
    for (std::size_t i = 0; i <= last; ++i) {
      responses_[i].p.setZero();
      responses_[i].k.setZero();
    }
    const int first = dual_.size();
    for (std::size_t b = 0; b < count; ++b) {
      const RowPlace& place = candidates_[begin + b];
      const auto& row = qp.stages[place.stage].rows[place.row];
      auto& work = work_[place.stage];
      responses_[place.stage].p.col(b) += row.C;
      responses_[place.stage].k.col(b) += row.D;
      work.known[place.row] = dual_.Add(work.lo[place.row], work.hi[place.row], row.rho, row.sigma, 0.0);
      known_.push_back(place);
    }
    detail::SweepRiccati(qp, riccati_, last, responses_);
    for (int a = 0; a < dual_.size(); ++a) {
      const RowPlace& place = known_[static_cast<std::size_t>(a)];
      const auto& row = qp.stages[place.stage].rows[place.row];
      const auto& response = responses_[place.stage];
      Eigen::Matrix<double, 1, kBatch> value;
      if (row.unit >= kNx) {
        value = response.du.row(row.unit - kNx);
      } else if (row.unit >= 0) {
        value = response.dx.row(row.unit);
      } else {
        value =
            detail::Product(row.C.transpose(), response.dx) + detail::Product(row.D.transpose(), response.du);
      }
      for (std::size_t b = 0; b < count; ++b)
        dual_.SetM(a, first + static_cast<int>(b), -value[static_cast<Eigen::Index>(b)]);
    }
  }
  return true;
}

// x, u, π of the dual's λ.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::MoveToMultipliers(const Qp& qp) {
  for (auto& sweep : sweep_) {
    sweep.p.setZero();
    sweep.k.setZero();
  }
  for (int a = 0; a < dual_.size(); ++a) {
    if (dual_.lambda(a) == 0.0) continue;
    const RowPlace& place = known_[static_cast<std::size_t>(a)];
    auto& sweep = sweep_[place.stage];
    detail::AddRowGradient(qp.stages[place.stage].rows[place.row], dual_.lambda(a), sweep.p, sweep.k);
  }
  detail::SweepRiccati(qp, riccati_, work_.size() - 1, sweep_);
  for (std::size_t i = 0; i < work_.size(); ++i) {
    auto& work = work_[i];
    work.x = sweep_[i].dx;
    work.u = sweep_[i].du;
  }
}

// The largest entry of the Lagrangian's gradient. Computes π.
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
  for (int a = 0; a < dual_.size(); ++a) {
    const RowPlace& place = known_[static_cast<std::size_t>(a)];
    auto& work = work_[place.stage];
    detail::AddRowGradient(qp.stages[place.stage].rows[place.row], dual_.lambda(a), work.r_x, work.r_u);
  }
  detail::LargestEntry<kNx> error_x;
  detail::LargestEntry<kNu> error_u;
  for (std::size_t i = 0; i < N; ++i) {
    const auto& work = work_[i];
    const VectorX& pi_next = work_[i + 1].pi;
    error_u.Add(work.r_u + detail::Product(qp.stages[i].B.transpose(), pi_next));
    if (i > 0) error_x.Add(work.r_x + detail::Product(qp.stages[i].A.transpose(), pi_next));
  }
  error_x.Add(work_[N].r_x);
  return std::max(error_x.Value(), error_u.Value());
}

template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::ProveByRay(const Qp& qp) {
  for (int a = 0; a < dual_.size(); ++a) {
    const RowPlace& place = known_[static_cast<std::size_t>(a)];
    const double ray = dual_.ray(a);
    point_.stages[place.stage].lambda[place.row] = {.lo = std::max(0.0, -ray), .hi = std::max(0.0, ray)};
  }
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
  for (int a = 0; a < dual_.size(); ++a) {
    const RowPlace& place = known_[static_cast<std::size_t>(a)];
    const auto& row = qp.stages[place.stage].rows[place.row];
    const auto& work = work_[place.stage];
    auto& at = point_.stages[place.stage];
    const double lambda = dual_.lambda(a);
    at.lambda[place.row] = {.lo = std::max(0.0, -lambda), .hi = std::max(0.0, lambda)};
    if (!row.soft()) continue;
    const double value = detail::RowValue(row, work.x, work.u);
    at.slack[place.row] =
        SlackOf(row, lambda, detail::Violation(work.lo[place.row], work.hi[place.row], value));
  }
}

}  // namespace control
