// A primal-dual point of an OcpQp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "control/qp/problem.hpp"

namespace control {

// Multipliers of a row: λ_lo of C x + D u + ε ≥ lo, λ_hi of C x + D u − ε ≤ hi; both ≥ 0. The multiplier of ε ≥ 0,
// where σ > 0, follows from them: λ_ε = ρ ε + σ − λ_lo − λ_hi.
struct RowMultiplier {
  double lo = 0.0;
  double hi = 0.0;

  // The multipliers with λ_hi − λ_lo = λ, one of which is zero.
  [[nodiscard]] static RowMultiplier FromDifference(double lambda) {
    return {.lo = std::max(0.0, -lambda), .hi = std::max(0.0, lambda)};
  }
  // True if the row is active: an interior point leaves a smaller multiplier on an inactive row.
  [[nodiscard]] bool IsActive() const { return std::max(lo, hi) > 1e-6; }
};

// π_i is the multiplier of the dynamics that give x_i (i ≥ 1); π_0 is unused.
template <int kNx, int kNu>
struct OcpQpPoint {
  struct Stage {
    Eigen::Matrix<double, kNx, 1> x = Eigen::Matrix<double, kNx, 1>::Zero();
    Eigen::Matrix<double, kNu, 1> u = Eigen::Matrix<double, kNu, 1>::Zero();
    Eigen::Matrix<double, kNx, 1> pi = Eigen::Matrix<double, kNx, 1>::Zero();
    std::array<RowMultiplier, kMaxRows> lambda{};
    std::array<double, kMaxRows> slack{};  // ε
  };
  explicit OcpQpPoint(int horizon) : stages(static_cast<std::size_t>(horizon) + 1) {}
  // Makes the point a warm start for the problem one stage later. The last two stages stay as they are, because the
  // rows of stage N differ from those of stage N − 1.
  void Shift() { std::copy(stages.begin() + 1, stages.end() - 1, stages.begin()); }

  std::vector<Stage> stages;
};

}  // namespace control
