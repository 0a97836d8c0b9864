// The rectangle on the road that a vehicle covers.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "control/vehicle/types.hpp"

namespace control {

// Distances from the centre of gravity along the vehicle's axes [m], each >= 0. If all are 0, the vehicle is a point,
// as in the paper.
struct Footprint {
  double front = 0.0;
  double rear = 0.0;
  double half_width = 0.0;

  // Front left, front right, rear right and rear left corner in the body frame.
  [[nodiscard]] std::array<Eigen::Vector2d, 4> Corners() const {
    return {{{front, half_width}, {front, -half_width}, {-rear, -half_width}, {-rear, half_width}}};
  }
  // Distance of the farthest corner from the centre of gravity [m].
  [[nodiscard]] double Reach() const { return std::hypot(std::max(front, rear), half_width); }
};

}  // namespace control
