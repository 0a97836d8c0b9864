// Reads the waypoints of a route from a CSV file: the header line `X,Y`, then one line of two numbers [m] per waypoint.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "config/toml_table.hpp"

namespace config {

// Blank lines are skipped. Throws ConfigError, such as "FILE:LINE: column 'Y' = "..." ...", if the file cannot be
// read, the header or the number of columns differs, a value is not a finite number within ±1000 km, a waypoint
// repeats its predecessor, or there are fewer than two.
[[nodiscard]] std::vector<Eigen::Vector2d> LoadWaypoints(const std::filesystem::path& file);

}  // namespace config
