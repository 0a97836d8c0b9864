// With what each controller is driven in a sweep.
#pragma once

#include <string>
#include <vector>

#include "config/route_file.hpp"
#include "loop/config.hpp"
#include "tools/scenarios/random_scenario.hpp"
#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

inline constexpr const char* kCostStandard = "nmpc";  // the controller that the others' cost is compared with
inline constexpr const char* kFixedRadius = "lpv-affine-fixed";  // its trust radius is not adapted

// The daemon's defaults, but for what follows from the ranges and, of a controller that takes the vehicle for a point,
// from its rectangle: obstacles are enlarged by half its width and what a corner stands out. lpv-affine reckons with the
// lowest μ of the range and the mean delay, and plans 2 s ahead; the paper's plan 0.4 s ahead as there. "nmpc" is here the
// one with lpv-affine's problem, nmpc-affine, by which the cost is measured. Throws std::invalid_argument: no such
// controller.
[[nodiscard]] loop::Config ConfigFor(const std::string& controller, const ScenarioRanges& ranges);

// The names of those that a sweep drives.
[[nodiscard]] std::vector<std::string> SweepControllers();

// Its road: for a point, narrower by the vehicle's width.
[[nodiscard]] config::RouteFile RouteFor(const RandomScenario& drawn, const loop::Config& config);

}  // namespace tools
