// A scenario drawn by chance: a bending road, a vehicle that is not what the controller takes it for, one to three
// obstacles. Nothing of it depends on who drives, nor on anything but the seed and the ranges.
//
// - Road: 7.5 to 9 s at the target speed, constant along it; straights, clothoids and arcs to either side, of at most
//   0.35 μ g lateral acceleration at the lowest μ of the range and of no less than 30 m radius; edges at ±4 m.
// - Vehicle: a rectangle of 4.25 m × 1.80 m, four wheels with saturating tyres, its own mass, friction, actuator lags
//   and delay, sensor noise; set down beside the road's middle, a little askew and off the target speed.
// - Obstacles: ellipses, each met at least 2.5 s after the start or the one before if the target speed is kept. About
//   one in three moves, about one in five is perceived late; of half of them it is told on which side to pass.
#pragma once

#include <cstdint>

#include "config/route_file.hpp"
#include "sim/scenario.hpp"
#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

// Of every scenario.
inline constexpr control::Footprint kVehicleFootprint{.front = 1.95, .rear = 2.30, .half_width = 0.90};

struct RandomScenario {
  sim::Scenario scenario;  // its description is one line that tells what was drawn
  // The controller's: that of the scenario and straight on, so that a long horizon, too, plans up to the scenario's end.
  config::RouteFile route;
};

[[nodiscard]] RandomScenario DrawScenario(std::uint64_t seed, const ScenarioRanges& ranges);

}  // namespace tools
