// A drive on a circular road past one circular obstacle (paper, Section Results: "a circular road with an obstacle
// blocking part of the road"), built from the parameters that determine its difficulty.
#pragma once

#include "config/route_file.hpp"
#include "loop/config.hpp"
#include "sim/scenario.hpp"

namespace tools {

struct CircleDrive {
  double speed = 12.0;  // [m/s]
  double shift = 0.5;   // sideways shift that clears the obstacle, 0 to its diameter [m]
  int horizon = 8;      // N
  loop::ControllerKind controller = loop::ControllerKind::kLpv;
};

inline constexpr double kCircleRadius = 100.0;        // radius of the road's reference path [m]
inline constexpr double kCircleObstacleRadius = 1.0;  // [m]
inline constexpr double kCircleRoadHalfWidth = 4.0;   // [m]

enum class CircleOutcome {
  kClear,       // every step solved, obstacle not touched, inside the road
  kMarginal,    // the first unsolved step is short of an obstacle by less than kMarginalShortfall
  kTouch,       // every step solved, obstacle touched
  kOffRoad,     // every step solved, off the road
  kInfeasible,  // another step unsolved, or the end not reached
};

// Shortfall of an obstacle constraint [m]: a tenth of the margin by which controllers enlarge obstacles.
inline constexpr double kMarginalShortfall = 0.01;

// Drives a left bend of 12 s with the obstacle after 7 s, to be passed on the left; everything else is the default.
[[nodiscard]] CircleOutcome Drive(const CircleDrive& drive);

}  // namespace tools
