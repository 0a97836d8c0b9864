// Those tables of the configuration file that concern the daemon's surroundings: bus, route, time, log, processor.
#pragma once

#include "loop/config_tables.hpp"

namespace loop {

[[nodiscard]] ConfigTable BusTable();
[[nodiscard]] ConfigTable RouteTable();
[[nodiscard]] ConfigTable CycleTable();
[[nodiscard]] ConfigTable LogTable();
[[nodiscard]] ConfigTable RealTimeTable();

}  // namespace loop
