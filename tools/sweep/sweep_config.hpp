// With what each controller is driven in a sweep.
#pragma once

#include <string>

#include "config/route_file.hpp"
#include "daemon/config.hpp"
#include "tools/sweep/random_scenario.hpp"
#include "tools/sweep/sweep_ranges.hpp"

namespace tools {

// The daemon's defaults, but for what follows from the ranges and, of a controller that takes the vehicle for a point,
// from its rectangle: obstacles are enlarged by half its width and what a corner stands out. lpv-affine reckons with the
// lowest μ of the range and the mean delay. It and NMPC plan 2 s ahead, the others 0.4 s as in the paper. Throws
// std::invalid_argument: no such controller.
[[nodiscard]] lpvmpcd::Config ConfigFor(const std::string& controller, const SweepRanges& ranges);

// Its road: for a point, narrower by the vehicle's width.
[[nodiscard]] config::RouteFile RouteFor(const RandomScenario& drawn, const lpvmpcd::Config& config);

}  // namespace tools
