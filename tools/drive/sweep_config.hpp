// The configuration of each controller in a sweep.
#pragma once

#include <string>
#include <vector>

#include "config/route_file.hpp"
#include "loop/config.hpp"
#include "tools/scenarios/random_scenario.hpp"
#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

inline constexpr const char* kFixedRadius =
    "lpv-affine-fixed";  // lpv-affine that does not adapt its trust radius

// The daemon's defaults, adapted to the ranges. For the paper's controllers, which treat the vehicle as a point,
// obstacles are also enlarged by half the vehicle's width and the swing of a corner. The affine controllers assume the
// lowest μ of the range and the mean delay, and plan 2 s ahead; the paper's controllers plan 0.4 s ahead, as in the
// paper. Throws std::invalid_argument if there is no such controller.
[[nodiscard]] loop::Config ConfigFor(const std::string& controller, const ScenarioRanges& ranges);

// The names of the controllers that a sweep can drive.
[[nodiscard]] std::vector<std::string> SweepControllers();

// The controller's road: for one that treats the vehicle as a point, narrower by the vehicle's width.
[[nodiscard]] config::RouteFile RouteFor(const RandomScenario& drawn, const loop::Config& config);

}  // namespace tools
