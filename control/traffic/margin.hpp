// Lateral distances that the vehicle keeps.
#pragma once

#include <algorithm>
#include <limits>

#include "control/vehicle/types.hpp"

namespace control {

// A distance: `wanted` at `speed`; if there is less room, less at a lower speed, down to `least` at walking pace.
struct Margin {
  double least = 0.0;   // [m]
  double wanted = 0.0;  // ≥ least [m]
  double speed = 45.0;  // [m/s]

  // The distance at r of the way from least to wanted, 0 ≤ r ≤ 1.
  [[nodiscard]] double At(double r) const { return least + r * (wanted - least); }
};

// The margin to an object for a vehicle that passes at `speed` [m/s]. `usual`: margin to things that do not move [m].
[[nodiscard]] inline Margin MarginTo(ObstacleClass object_class, double speed, double usual) {
  switch (object_class) {
    case ObstacleClass::kPedestrian:
      return {
          .least = 0.5, .wanted = std::max({usual, 0.5, std::min(0.6 + 0.08 * speed, 2.0)}), .speed = speed};
    case ObstacleClass::kCycle:
      return {
          .least = 0.5, .wanted = std::max({usual, 0.5, std::min(0.8 + 0.05 * speed, 1.5)}), .speed = speed};
    case ObstacleClass::kVehicle:
      return {.least = std::min(0.15, usual), .wanted = std::max(usual, std::min(0.2 + 0.02 * speed, 0.6))};
    case ObstacleClass::kUnknown:
    case ObstacleClass::kStatic:
      break;
  }
  return {.least = std::min(0.1, usual), .wanted = usual};
}

// The highest speed in a gap whose margins are r of the way from least to wanted, 0 ≤ r ≤ 1 [m/s]; `speed`: that at
// which the margins are wanted.
[[nodiscard]] inline double SpeedInGap(double r, double speed) {
  constexpr double kWalkingPace = 2.0;  // [m/s]
  return r >= 1.0 ? std::numeric_limits<double>::infinity()
                  : kWalkingPace + r * std::max(speed - kWalkingPace, 0.0);
}

}  // namespace control
