// The daemon's configuration that a command drives a scenario with.
#pragma once

#include <filesystem>

#include "loop/config.hpp"
#include "sim/scenario.hpp"

namespace tools {

// That of `file`, or where this is empty, the one that the scenario, read from `scenario_file`, names. Throws
// config::ConfigError.
[[nodiscard]] loop::Config LoadConfigFor(const sim::Scenario& scenario,
                                         const std::filesystem::path& scenario_file,
                                         const std::filesystem::path& file);

}  // namespace tools
