// The daemon's configuration with which a command drives a scenario.
#pragma once

#include <filesystem>

#include "loop/config.hpp"
#include "sim/scenario.hpp"

namespace tools {

// Loads `file`, or if it is empty, the configuration named by the scenario, which was read from `scenario_file`. Throws
// config::ConfigError if neither names a file, or if the file is missing or wrong.
[[nodiscard]] loop::Config LoadConfigFor(const sim::Scenario& scenario,
                                         const std::filesystem::path& scenario_file,
                                         const std::filesystem::path& file);

}  // namespace tools
