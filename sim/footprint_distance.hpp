// Distance from a vehicle's rectangle to an obstacle.
#pragma once

#include <Eigen/Core>

#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"

namespace sim {

// Signed distance [m] from the footprint, its centre of gravity at `position` and its front towards `heading` [rad], to
// the obstacle's edge. Without contact it is exact to round-off. In contact it is negative. In a
// box, it is then the least distance that separates the two; in an ellipse, the depth of the rectangle's point that is
// deepest as a fraction of the ellipse's radius through it, and separating the two may take a greater distance. The
// obstacle's semi-axes must be positive.
[[nodiscard]] double FootprintDistance(const control::Obstacle& obstacle, const control::Footprint& footprint,
                                       const Eigen::Vector2d& position, double heading);

}  // namespace sim
