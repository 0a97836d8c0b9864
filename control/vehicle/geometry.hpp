// Vectors in the map.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "control/vehicle/types.hpp"

namespace control {

[[nodiscard]] inline Eigen::Vector2d Along(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

[[nodiscard]] inline Eigen::Vector2d LeftOf(double angle) {
  return {-std::sin(angle), std::cos(angle)};
}

[[nodiscard]] inline Eigen::Vector2d Position(const State& z) {
  return {z[kX], z[kY]};
}

// Vector from the vehicle's centre of gravity to the point `fixed` of its body, in the map.
[[nodiscard]] inline Eigen::Vector2d Rotate(double psi, const Eigen::Vector2d& fixed) {
  return Eigen::Rotation2Dd(psi) * fixed;
}

}  // namespace control
