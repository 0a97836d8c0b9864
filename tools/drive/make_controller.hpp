// Makes any controller that a configuration can name, including those that the daemon does not offer. The objects that
// `road` refers to must outlive the controller.
#pragma once

#include <memory>

#include "control/mpc/controller.hpp"
#include "loop/assembly.hpp"
#include "loop/config.hpp"

namespace tools {

[[nodiscard]] std::unique_ptr<control::Controller> MakeController(const loop::Config& config,
                                                                  const loop::Road& road);

}  // namespace tools
