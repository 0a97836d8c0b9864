// A random scenario with traffic: a point of the unit cube (traffic_point.hpp) is one scenario, so that a sweep can draw
// points at random and a search can look for bad ones.
//
// - Road: traffic_road.hpp. The controller's road ends where the scenario's does.
// - Objects: traffic_objects.hpp; of each kind there are none, one or, oncoming, crossing and parked ones, two.
// - Vehicle: drawn_vehicle.hpp. About one in five has a steering offset of up to 1°, one in five drives on a bank of up to
//   5 %, one in six meets a gust. The controller is told the lowest friction of the range, not that of the road.
#pragma once

#include "tools/scenarios/random_scenario.hpp"
#include "tools/scenarios/scenario_ranges.hpp"
#include "tools/scenarios/traffic_point.hpp"

namespace tools {

[[nodiscard]] RandomScenario DrawTraffic(const TrafficPoint& point, const ScenarioRanges& ranges);

}  // namespace tools
