// Reads how an obstacle of a scenario file moves along the route: the keys along_route, speed, speed_profile,
// lateral_profile and follows of sim/scenario.hpp, with s, lateral and heading as start.
#pragma once

#include <optional>

#include "config/toml_table.hpp"
#include "control/road/route.hpp"
#include "sim/route_motion.hpp"

namespace sim {

// Ranges of an obstacle's keys in the scenario file.
inline constexpr config::Range<double> kObstacleLateral{-50.0, 50.0};  // [m]
inline constexpr config::Range<double> kObstacleHeading{-6.3, 6.3};    // [rad]
inline constexpr config::Range<double> kObstacleSpeed{-60.0, 60.0};    // as ObstacleObject has room for [m/s]
inline constexpr config::Range<double> kScenarioTime{0.0, 1e5};        // [s]

// nullopt if the table does not ask for such a motion. Throws config::ConfigError.
[[nodiscard]] std::optional<RouteMotion> ReadRouteMotion(const config::TomlTable& table,
                                                         const control::Route& route);

}  // namespace sim
