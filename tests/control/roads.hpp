// Roads for tests.
#pragma once

#include <array>
#include <numbers>

#include "control/road/route.hpp"

namespace control::testing {

inline Route StraightRoad(double length, double speed) {
  return Route::FromPieces({}, speed, std::array{RoutePiece{.length = length}});
}

// A circle to the left, without a clothoid before it.
inline Route CircularRoad(double radius, double turns, double speed) {
  const double curvature = 1.0 / radius;
  return Route::FromPieces({}, speed,
                           std::array{RoutePiece{.length = 2.0 * std::numbers::pi * radius * turns,
                                                 .curvature_from = curvature,
                                                 .curvature_to = curvature}});
}

// Straight, left, right and straight, joined by clothoids.
inline Route WindingRoad(double radius, double speed) {
  constexpr double kClothoid = 20.0, kArc = 30.0, kStraight = 50.0;
  const double k = 1.0 / radius;
  return Route::FromPieces(
      {.X = 3.0, .Y = -2.0, .psi = 0.7}, speed,
      std::array{RoutePiece{.length = kStraight},
                 RoutePiece{.length = kClothoid, .curvature_from = 0.0, .curvature_to = k},
                 RoutePiece{.length = kArc, .curvature_from = k, .curvature_to = k},
                 RoutePiece{.length = 2.0 * kClothoid, .curvature_from = k, .curvature_to = -k},
                 RoutePiece{.length = kArc, .curvature_from = -k, .curvature_to = -k},
                 RoutePiece{.length = kClothoid, .curvature_from = -k, .curvature_to = 0.0},
                 RoutePiece{.length = kStraight}});
}

// A road out and back; the second leg is `apart` [m] to the left of the first.
inline Route HairpinRoad(double leg, double apart, double speed) {
  const double curvature = 2.0 / apart;
  return Route::FromPieces({}, speed,
                           std::array{RoutePiece{.length = leg},
                                      RoutePiece{.length = 0.5 * std::numbers::pi * apart,
                                                 .curvature_from = curvature,
                                                 .curvature_to = curvature},
                                      RoutePiece{.length = leg}});
}

}  // namespace control::testing
