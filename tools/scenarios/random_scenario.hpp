// A random scenario: a winding road, a vehicle that differs from the controller's model, and one to three obstacles. It
// depends only on the seed and the ranges, not on the controller.
//
// - Road: 7.5 to 9 s at a constant target speed; straights, clothoids and arcs to either side, with at most 0.35 μ g
//   lateral acceleration at the lowest μ of the range and a radius of at least 30 m; edges at ±4 m.
// - Vehicle: a rectangle of 4.25 m × 1.80 m on four wheels with saturating tyres; random mass, friction, actuator lags
//   and delay, sensor noise; its initial place, heading and speed deviate from the road's middle and the target speed.
// - Obstacles: ellipses, each met at least 2.5 s after the start or the previous one if the target speed is kept. About
//   one in three moves, about one in five is perceived late; for about half of them the passing side is prescribed.
//
// With ranges.traffic it is another one: traffic_scenario.hpp.
#pragma once

#include <cstdint>

#include "config/route_file.hpp"
#include "sim/scenario.hpp"
#include "tools/scenarios/drawn_vehicle.hpp"
#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

struct RandomScenario {
  sim::Scenario scenario;  // its description is one line that lists what was drawn
  // The controller's route: that of the scenario, without traffic extended straight ahead so that a long horizon can plan
  // up to the scenario's end.
  config::RouteFile route;
};

[[nodiscard]] RandomScenario DrawScenario(std::uint64_t seed, const ScenarioRanges& ranges);

}  // namespace tools
