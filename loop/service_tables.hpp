// The tables of the configuration file for the daemon's environment: bus, route, cycle, log, real time.
#pragma once

#include "loop/config_tables.hpp"

namespace loop {

[[nodiscard]] ConfigTable BusTable();
[[nodiscard]] ConfigTable RouteTable();
[[nodiscard]] ConfigTable CycleTable();
[[nodiscard]] ConfigTable LogTable();
[[nodiscard]] ConfigTable RealTimeTable();

}  // namespace loop
