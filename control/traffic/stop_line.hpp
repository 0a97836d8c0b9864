// A line across the road that the vehicle's centre must not pass; it may move along the road.
#pragma once

namespace control {

struct StopLine {
  double s = 0.0;      // current arc length [m]
  double speed = 0.0;  // ≥ 0 [m/s]
  double spare = 0.0;  // distance beyond it that is kept only for comfort [m]
};

}  // namespace control
