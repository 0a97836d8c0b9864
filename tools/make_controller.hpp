// The controller that a configuration names: any of them, also those that no daemon drives by. `course` outlives it.
#pragma once

#include <memory>

#include "control/controller.hpp"
#include "control/course.hpp"
#include "daemon/config.hpp"

namespace tools {

[[nodiscard]] std::unique_ptr<control::Controller> MakeController(const lpvmpcd::Config& config,
                                                                  const control::Course& course);

}  // namespace tools
