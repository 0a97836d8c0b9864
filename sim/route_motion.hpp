// How an object moves along the route: arc length and offset of its centre as functions of time.
//
// The speed along the route (arc length per time, negative against the route's direction) is linear between the points of
// its profile, so that the arc length is a piecewise quadratic function of time, evaluated in closed form. The offset
// follows half a period of a cosine between two points of its profile, so that it has no lateral speed at a point.
#pragma once

#include <vector>

#include "control/road/route.hpp"
#include "control/vehicle/types.hpp"

namespace sim {

struct SpeedPoint {
  double time = 0.0;   // since the start [s]
  double speed = 0.0;  // along the route [m/s]
};

struct LateralPoint {
  double time = 0.0;     // since the start [s]
  double lateral = 0.0;  // left positive [m]
};

// Each profile has at least one point, by increasing time from 0 on; it is constant before the first and after the last.
struct RouteMotion {
  double s = 0.0;        // of the centre at the start [m]
  double heading = 0.0;  // relative to the road [rad]
  std::vector<SpeedPoint> speed{{}};
  std::vector<LateralPoint> lateral{{}};
  bool follows = false;  // a driver (sim/follower.hpp) with the first point's speed as desired speed
};

struct RouteState {
  double s = 0.0;             // [m]
  double speed = 0.0;         // of s [m/s]
  double lateral = 0.0;       // [m]
  double lateral_rate = 0.0;  // [m/s]
};

// The state `time` [s] after the start, for an object that does not follow.
[[nodiscard]] RouteState StateAt(const RouteMotion& motion, double time);

// Sets lateral and lateral_rate of `state` as they are `time` [s] after the start.
void ShiftTo(const RouteMotion& motion, double time, RouteState& state);

// The object with position, heading and velocity of a body in `state`. Its heading is the road's there, plus `heading`
// and the angle by which it drifts off the road's direction: at most 45°, and none while it does not move along the road.
[[nodiscard]] control::Obstacle OnRoute(control::Obstacle object, const control::Route& route, double heading,
                                        const RouteState& state);

}  // namespace sim
