// Those tables of the configuration file that concern the controllers and their model of the vehicle.
#pragma once

#include "loop/config_tables.hpp"

namespace loop {

[[nodiscard]] ConfigTable ControllerTable();  // the choice, and the paper's controllers
[[nodiscard]] ConfigTable LpvAffineTable();
[[nodiscard]] ConfigTable VehicleTable();

}  // namespace loop
