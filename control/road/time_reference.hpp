// The reference trajectory z_ref from (X, Y) alone (paper, Section NMPC, eq:psi_ref and eq:glob_to_loc),
// indexed by time: point k is where the vehicle should be at k t_s.
//
// Errata decided here:
//  - eq:psi_ref: the arctan of a ratio loses the quadrant and jumps; ψ_ref is the atan2 of the forward difference,
//    unwrapped along the path.
//  - after eq:glob_to_loc: the rotated difference is the displacement itself; υ_ref = x_ref / t_s,
//    ν_ref = y_ref / t_s.
#pragma once

#include <span>
#include <vector>

#include "control/vehicle/types.hpp"

namespace control {

class TimeReference {
 public:
  // Requires at least two points, each different from its predecessor, and t_s > 0 [s]. Throws std::invalid_argument,
  // which names the point, otherwise.
  TimeReference(std::span<const Eigen::Vector2d> points, double t_s);

  [[nodiscard]] int size() const { return static_cast<int>(z_.size()); }
  [[nodiscard]] const State& operator[](int k) const { return z_[static_cast<std::size_t>(k)]; }

  // z_ref of step k; past the end, the last state continues straight at its speed.
  [[nodiscard]] State At(int k) const;
  // Length of the path to the point of step k, as the sum of its chords [m].
  [[nodiscard]] double ArcLength(int k) const;
  // Writes z_ref of steps k, k+1, ... to `out`.
  void Window(int k, std::span<State> out) const;

 private:
  std::vector<State> z_;
  std::vector<double> s_;  // [m]
  double t_s_;
};

}  // namespace control
