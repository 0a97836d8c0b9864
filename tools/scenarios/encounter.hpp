// When and where a vehicle that keeps the target speed meets an obstacle.
#pragma once

#include <vector>

#include "control/vehicle/types.hpp"
#include "sim/scenario.hpp"

namespace tools {

struct Encounter {
  control::Obstacle obstacle;   // at its position at `time`
  double time = 0.0;            // time since the start [s]; both are then at the same place along the route
  double perceived_at = 0.0;    // [s]
  double s = 0.0;               // place of its centre along the route [m]
  double lateral = 0.0;         // offset of its centre, left positive [m]
  double half_length = 0.0;     // along the route [m]
  double half_width = 0.0;      // across it [m]
  double velocity_along = 0.0;  // negative if it moves towards the vehicle [m/s]
};

// The encounters in the order of their times. An obstacle that is never met on the route, or is behind the vehicle at
// the start, has none. The route's target speed must be constant, and no obstacle may be faster.
[[nodiscard]] std::vector<Encounter> Encounters(const sim::Scenario& scenario);

}  // namespace tools
