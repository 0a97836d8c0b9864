// A constraint that cannot be met, in words.
#pragma once

#include <string>

#include "control/mpc/constraint.hpp"

namespace loop {

// "obstacle 1 at i = 8, short of 31.0 mm"
[[nodiscard]] std::string ViolationText(const control::ConstraintViolation& violation);

}  // namespace loop
