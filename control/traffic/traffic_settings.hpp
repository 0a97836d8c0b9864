// Settings of the decisions about other things on the road.
#pragma once

#include "control/traffic/path_smoother.hpp"
#include "control/vehicle/footprint.hpp"

namespace control {

struct TrafficSettings {
  Footprint footprint;
  double obstacle_margin = 0.3;  // [m]
  double road_margin = 0.4;      // [m]
  double stop_gap = 2.0;         // gap to an object that blocks the way [m]
  double t_s = 0.05;             // time between two plans [s]
  double headway = 1.0;          // additional gap to an object that moves ahead, in time [s]
  double grip = 5.0;             // acceleration that the tyres can provide [m/s²]
  double curvature_rate = 0.2;   // at which the steering can change the path's curvature [1/(m s)]
  double horizon = 8.0;          // [s]
  PathSmootherSettings path;
};

}  // namespace control
