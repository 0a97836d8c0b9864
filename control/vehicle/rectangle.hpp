// A rectangle in the map, for a vehicle's footprint and for an obstacle that is a box.
#pragma once

#include <Eigen/Core>

#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"

namespace control {

struct Rectangle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_sides = Eigen::Vector2d::Zero();  // along and across `heading` [m], each >= 0
  double heading = 0.0;                                  // [rad]
};

// The rectangle of a vehicle whose centre of gravity is at `position`.
[[nodiscard]] Rectangle RectangleOf(const Footprint& footprint, const Eigen::Vector2d& position,
                                    double heading);

// The rectangle with the obstacle's half sides.
[[nodiscard]] Rectangle RectangleOf(const Obstacle& obstacle);

// The least distance by which one rectangle must be moved so that they only touch [m]. If they are apart, it is
// minus the widest gap along a side's normal, which is at most their distance.
[[nodiscard]] double Overlap(const Rectangle& a, const Rectangle& b);

// The distance of two rectangles [m]; 0 if they overlap.
[[nodiscard]] double Distance(const Rectangle& a, const Rectangle& b);

}  // namespace control
