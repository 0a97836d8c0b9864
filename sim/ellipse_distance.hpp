// Distance from a point to an ellipse.
#pragma once

#include "control/vehicle/types.hpp"

namespace sim {

// Signed distance from (X, Y) to the obstacle's edge [m], negative inside, accurate to about 1e-12 of the obstacle's
// size. The semi-axes must be positive.
[[nodiscard]] double EllipseDistance(const control::Obstacle& obstacle, double X, double Y);

}  // namespace sim
