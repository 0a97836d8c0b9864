// Obstacle avoidance as one half-space a X + b Y ≥ c per step (paper, Section linobs, Algorithm 1): where the
// reference point lies inside the obstacle's ellipse, it is projected along the road's normal onto the circumference,
// on the side on which the obstacle is passed, and the vehicle is kept beyond the tangent at that point.
// A box counts as the ellipse through its corners, whose semi-axes are √2 times the half sides.
#pragma once

#include <optional>

#include "control/vehicle/types.hpp"

namespace control {

// Points with a X + b Y ≥ c; (a, b) has length 1, so a X + b Y − c is the distance [m].
struct HalfSpace {
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;
};

// The half-space for the reference state `z_ref`, or nullopt if its point lies outside the obstacle, whose semi-axes
// are first enlarged by `margin` [m]. An unknown side is resolved to the shorter way out along the road's normal.
[[nodiscard]] std::optional<HalfSpace> ObstacleHalfSpace(const Obstacle& obstacle, const State& z_ref,
                                                         double margin);

}  // namespace control
