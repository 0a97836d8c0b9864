// The ranges of the values of a route, in its TOML file and in files of waypoints.
#pragma once

#include "config/toml_table.hpp"

namespace config {

inline constexpr Range<double> kPositionRange{-1e6, 1e6};  // [m]
inline constexpr Range<double> kSpeedRange{0.1, 100.0};    // [m/s]
inline constexpr Range<double> kWidthRange{0.1, 100.0};    // from the path to an edge of the road [m]

}  // namespace config
