// The controller that a configuration names: any of them, also those that no daemon drives by. What `road` refers to outlives it.
#pragma once

#include <memory>

#include "control/mpc/controller.hpp"
#include "loop/assembly.hpp"
#include "loop/config.hpp"

namespace tools {

[[nodiscard]] std::unique_ptr<control::Controller> MakeController(const loop::Config& config,
                                                                  const loop::Road& road);

}  // namespace tools
