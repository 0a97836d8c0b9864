// The road of a scenario with traffic.
//
// - Two lanes, with the reference path in the middle of the right one; one wide lane about the path; or a narrow street.
//   On about half of the roads there is a stretch that is narrower or wider. The least distance from the path to an edge is
//   that of a lane of the vehicle's width plus 0.3 m, and in bends what its ends need besides.
// - 10 to 18 s at the target speed, but at most 600 m, with up to three bends. A gentle one needs 0.12 to 0.8 μ g of lateral
//   acceleration at the target speed. Before a sharp one, of 12 to 45 m radius and up to a hairpin, the target speed falls to
//   what 0.12 to 0.8 μ g allow there, with 0.35 μ g at most, and rises again after it. The road never turns back by more than
//   half a turn, so that it does not meet itself.
#pragma once

#include <string>

#include "control/road/road_edges.hpp"
#include "control/road/route.hpp"
#include "tools/scenarios/point_reader.hpp"
#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

struct TrafficRoad {
  control::Route route;
  control::RoadEdges edges;
  std::string description;  // "two lanes, 12.1 m/s down to 6.3, 2 bends, 2.9 m at its narrowest"
};

// Reads kRoadCoordinates. `mu`: friction coefficient of the road.
[[nodiscard]] TrafficRoad DrawTrafficRoad(PointReader reader, const Interval& speed, double mu);

}  // namespace tools
