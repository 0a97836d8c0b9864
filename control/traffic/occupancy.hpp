// What others may do in the next seconds, by the bounds that docs/safety.md states:
//
//   moves along the road ahead    goes on at its speed, or brakes by up to 8 m/s²
//   comes towards the vehicle,    goes on at its speed for the first second, then brakes by at least 3 m/s² for a vehicle
//   or overtakes it               that stands in its way; or brakes by up to 8 m/s² at once
//   crosses                       goes straight on at its speed, or brakes by up to 8 m/s²
//
// It keeps its lateral position or velocity (road_object.hpp), and what stands stays where it is. The literature calls such
// bounds those of responsible behaviour (Shalev-Shwartz et al., arXiv 1708.06374).
#pragma once

#include "control/traffic/road_object.hpp"
#include "control/vehicle/types.hpp"

namespace control {

// Of the places where the object may be `time` [s] later, the one nearest to a vehicle at `position` beside the road's arc
// length s [m]: the time after which the object would be there at its present speed [s]. The vehicle begins to brake at
// arc length `s_0`.
[[nodiscard]] double TimeToNearest(const Obstacle& obstacle, const RoadObject& object, double time,
                                   const Eigen::Vector2d& position, double s, double s_0);

}  // namespace control
