// The best feasible point available after a solve that was stopped early.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "control/qp/kkt.hpp"
#include "control/qp/point.hpp"
#include "control/qp/problem.hpp"
#include "control/qp/rows.hpp"

namespace control {

// Sets the slacks of the soft rows to the smallest that x, u permit. Returns the cost; infinity if a hard row is
// violated by more than the tolerance or the cost is not finite.
template <int kNx, int kNu>
[[nodiscard]] double FillSlacks(const OcpQp<kNx, kNu>& qp, double tolerance, OcpQpPoint<kNx, kNu>& point) {
  bool hold = true;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    auto& at = point.stages[i];
    const double violation = detail::Violation(row.lo, row.hi, detail::RowValue(row, at.x, at.u));
    at.slack[j] = row.soft() ? std::max(0.0, violation) : 0.0;
    hold = hold && (row.soft() || violation <= tolerance);
  });
  const double cost = EvaluateCost(qp, point);
  if (!hold || !std::isfinite(cost)) return kNoBound;
  return cost;
}

// Replaces `point` by the trajectory of the warm start's inputs (may be null) if that is feasible, and `point` costs
// more or is infeasible. False if neither is feasible; x, u of `point` are then unchanged. `scratch` is work space.
template <int kNx, int kNu>
[[nodiscard]] bool SettleForFeasible(const OcpQp<kNx, kNu>& qp, double tolerance,
                                     const OcpQpPoint<kNx, kNu>* warm_start, OcpQpPoint<kNx, kNu>& scratch,
                                     OcpQpPoint<kNx, kNu>& point) {
  const double own_cost = FillSlacks(qp, tolerance, point);
  if (warm_start == nullptr) return own_cost < kNoBound;
  scratch = *warm_start;
  scratch.stages[0].x = qp.x0;
  for (std::size_t i = 0; i + 1 < qp.stages.size(); ++i) {
    const auto& stage = qp.stages[i];
    const auto& at = scratch.stages[i];
    scratch.stages[i + 1].x = stage.A * at.x + stage.B * at.u + stage.c;
  }
  const double cost = FillSlacks(qp, tolerance, scratch);
  if (cost < own_cost) point = scratch;
  return std::min(cost, own_cost) < kNoBound;
}

}  // namespace control
