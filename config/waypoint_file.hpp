// Waypoints of a route from a CSV file: the header line `X,Y`, then a line of two numbers [m] for each waypoint.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "config/toml_table.hpp"

namespace config {

// Blank lines are passed over. Throws ConfigError "FILE:LINE: column 'Y' = "..." ...": the file cannot be
// read, the header differs, a value is not a finite number within 1000 km, a waypoint repeats its
// predecessor, or there are fewer than two.
[[nodiscard]] std::vector<Eigen::Vector2d> LoadWaypoints(const std::filesystem::path& file);

}  // namespace config
