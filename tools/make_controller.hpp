// The controller that a configuration names: any of them, also those that no daemon drives by.
#pragma once

#include <memory>

#include "control/controller.hpp"
#include "daemon/config.hpp"

namespace tools {

[[nodiscard]] std::unique_ptr<control::Controller> MakeController(const lpvmpcd::Config& config);

}  // namespace tools
