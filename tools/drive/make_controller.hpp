// The controller that a configuration names: any of them, also those that no daemon drives by. `course` outlives it.
#pragma once

#include <memory>

#include "control/mpc/controller.hpp"
#include "control/road/road_profile.hpp"
#include "loop/config.hpp"

namespace tools {

[[nodiscard]] std::unique_ptr<control::Controller> MakeController(const loop::Config& config,
                                                                  const control::RoadProfile& course);

}  // namespace tools
