// Distance of a vehicle's rectangle to an ellipse.
#pragma once

#include <Eigen/Core>

#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"

namespace sim {

// Signed distance [m] of the footprint, its centre of gravity at `position` and its front towards `heading` [rad], to
// the obstacle's edge. Outside it is exact to round-off. In contact it is negative: the depth of that point of the
// rectangle which is deepest by the ellipse's own measure, the ratio in which it divides a radius; the distance that
// would part them may be greater. The obstacle's semi-axes must be above 0.
[[nodiscard]] double FootprintDistance(const control::Obstacle& obstacle, const control::Footprint& footprint,
                                       const Eigen::Vector2d& position, double heading);

}  // namespace sim
