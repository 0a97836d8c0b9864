// A drive on a circular road past one circular obstacle (paper, Section Results: "a circular road with an obstacle
// blocking part of the road"), made from the figures that decide how hard it is.
#pragma once

#include "config/route_file.hpp"
#include "loop/config.hpp"
#include "sim/scenario.hpp"

namespace tools {

struct CircleDrive {
  double speed = 12.0;  // [m/s]
  double shift = 0.5;   // by which the path has to give way to clear the obstacle, 0 to its diameter [m]
  int horizon = 8;      // N
  loop::ControllerKind controller = loop::ControllerKind::kLpv;
};

inline constexpr double kCircleRadius = 100.0;        // of the road's reference path [m]
inline constexpr double kCircleObstacleRadius = 1.0;  // [m]
inline constexpr double kCircleRoadHalfWidth = 4.0;   // [m]

enum class CircleOutcome {
  kClear,       // every step solved, obstacle not touched, inside the road
  kMarginal,    // not every step solved, but the first that was not lacked less than kMarginalShortfall
  kTouch,       // every step solved, obstacle touched
  kOffRoad,     // every step solved, off the road
  kInfeasible,  // any other step not solved, or the end not reached
};

// Of a constraint [m]: a tenth of the margin by which controllers see obstacles enlarged.
inline constexpr double kMarginalShortfall = 0.01;

// A left bend of 12 s, the obstacle after 7 s, to be passed on the left; everything else by default.
[[nodiscard]] CircleOutcome Drive(const CircleDrive& drive);

}  // namespace tools
