// Distance of a point to an ellipse.
#pragma once

#include "control/vehicle/types.hpp"

namespace sim {

// Signed distance of (X, Y) to the obstacle's edge [m], negative inside, to about 1e-12 of its size. The semi-axes
// must be above 0.
[[nodiscard]] double EllipseDistance(const control::Obstacle& obstacle, double X, double Y);

}  // namespace sim
