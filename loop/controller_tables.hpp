// The tables of the configuration file for the controllers and their vehicle model.
#pragma once

#include "loop/config_tables.hpp"

namespace loop {

[[nodiscard]] ConfigTable ControllerTable();  // selection of a controller, and the paper's controllers
[[nodiscard]] ConfigTable LpvAffineTable();
[[nodiscard]] ConfigTable VehicleTable();

}  // namespace loop
