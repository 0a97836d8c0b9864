// The objects of a scenario with traffic, one function for each kind. Each reads its coordinates, adds what it draws to the
// scenario, or nothing, and returns what it added in words; empty: nothing.
//
// "Met" is the time at which a vehicle with the target speed is at the object's place on the road. An object is perceived
// some time before it is met, at least 1.0 s; many from the start. Objects do not heed each other.
#pragma once

#include <string>

#include "sim/scenario.hpp"
#include "tools/scenarios/point_reader.hpp"

namespace tools {

// A vehicle from behind that wants 0.6 to 1.5 times the target speed and keeps a distance to ours (sim/follower.hpp). Its
// gap at the start is at least 6 m and what it needs to slow down to the target speed with 3 m/s².
[[nodiscard]] std::string AddFollower(PointReader reader, sim::Scenario& scenario);

// A vehicle or cycle ahead in the lane at 0 to 1.1 times the target speed, with a gap of at least a second and of what our
// vehicle needs to slow down to its speed with 3 m/s². About half of them brake at some time, by 2 to 6 m/s², to standstill or
// a lower speed, and drive on after up to 8 s or never.
[[nodiscard]] std::string AddLeader(PointReader reader, sim::Scenario& scenario);

// One that comes towards the vehicle and keeps to the road's left edge. Where that does not leave room for our vehicle and
// 0.9 m besides, it is a cycle; where not even that does, it brakes for our vehicle.
[[nodiscard]] std::string AddOncoming(PointReader reader, sim::Scenario& scenario);

// A pedestrian, cycle or vehicle that crosses at constant velocity, and is on the path up to 1.5 s before or after our
// vehicle would be.
[[nodiscard]] std::string AddCrossing(PointReader reader, sim::Scenario& scenario);

// Four to twelve small things that stand on one side of the road and leave a gap on the other.
[[nodiscard]] std::string AddGroup(PointReader reader, sim::Scenario& scenario);

// Three to ten cones, trees or parked cars along the whole road, beyond its edges by 0.05 to 4 m.
[[nodiscard]] std::string AddBeside(PointReader reader, sim::Scenario& scenario);

// A vehicle that stands at an edge and covers up to 2.5 m of the road.
[[nodiscard]] std::string AddParked(PointReader reader, sim::Scenario& scenario);

}  // namespace tools
