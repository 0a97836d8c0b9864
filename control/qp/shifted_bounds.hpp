// The bounds of an OcpQp's rows for deviations from the unconstrained optimum.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "control/qp/largest_entry.hpp"
#include "control/qp/point.hpp"
#include "control/qp/problem.hpp"
#include "control/qp/rows.hpp"
#include "control/qp/unconstrained.hpp"

namespace control {

template <int kNx, int kNu>
class ShiftedBounds {
 public:
  struct Stage {
    std::array<double, kMaxRows> lo, hi;
  };

  explicit ShiftedBounds(int horizon) : stages_(static_cast<std::size_t>(horizon) + 1) {}

  // Returns the largest violation of a row at the unconstrained optimum; infinity if a row's value is not finite. Rows
  // with zero penalty do not count.
  [[nodiscard]] double Shift(const OcpQp<kNx, kNu>& qp, const Unconstrained<kNx, kNu>& optimum) {
    double violation = 0.0;
    has_zero_penalties_ = false;
    detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
      auto& at = stages_[i];
      const double value = detail::RowValue(row, optimum[i].x, optimum[i].u);
      at.lo[j] = row.lo - value;
      at.hi[j] = row.hi - value;
      const double beyond = std::max(at.lo[j], -at.hi[j]);
      if (row.has_zero_penalty()) {
        has_zero_penalties_ = true;
      } else if (!(beyond <= 0.0)) {
        detail::Raise(violation, beyond);
      }
    });
    return violation;
  }

  // Sets the slacks that rows with zero penalty need at the point.
  void FillFreeSlacks(const OcpQp<kNx, kNu>& qp, OcpQpPoint<kNx, kNu>& point) const {
    if (!has_zero_penalties_) return;
    detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
      if (!row.has_zero_penalty()) return;
      auto& at = point.stages[i];
      const double value = detail::RowValue(row, at.x, at.u);
      at.slack[j] = std::max(0.0, detail::Violation(row.lo, row.hi, value));
    });
  }

  [[nodiscard]] const Stage& operator[](std::size_t i) const { return stages_[i]; }

 private:
  std::vector<Stage> stages_;
  bool has_zero_penalties_ = false;
};

}  // namespace control
