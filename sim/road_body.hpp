// The vehicle or an object in the coordinates of the road beside which it is: arc length of the route and offset to the
// left. What it covers is measured along and across the road's direction at its centre, as if the road went straight on.
#pragma once

#include "control/road/route.hpp"
#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"

namespace sim {

struct RoadBody {
  double s = 0.0;        // of the centre; for the vehicle, of the centre of gravity [m]
  double lateral = 0.0;  // [m]
  double heading = 0.0;  // relative to the road [rad]
  double rear = 0.0;     // the stretch of road that it covers [m]
  double front = 0.0;
  double right = 0.0;  // the offsets that it covers [m]
  double left = 0.0;
  double speed = 0.0;          // along the road [m/s]
  double lateral_speed = 0.0;  // [m/s]
};

// `place` is the projection of the position onto the route.
[[nodiscard]] RoadBody VehicleOnRoad(const control::State& z, const control::Footprint& footprint,
                                     const control::Route& route, const control::RouteProjection& place);
[[nodiscard]] RoadBody ObjectOnRoad(const control::Obstacle& object, const control::Route& route,
                                    const control::RouteProjection& place);

// Whether the two cover common offsets.
[[nodiscard]] inline bool InSameLane(const RoadBody& a, const RoadBody& b) {
  return a.right < b.left && b.right < a.left;
}

}  // namespace sim
