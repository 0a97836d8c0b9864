// The text for a constraint that cannot be met.
#pragma once

#include <string>

#include "control/mpc/constraint.hpp"

namespace loop {

// "obstacle 1 at i = 8, short of 31.0 mm"
[[nodiscard]] std::string ViolationText(const control::ConstraintViolation& violation);

}  // namespace loop
