// Whether a plan may be followed, and how the bus is told.
#pragma once

#include "control/controller.hpp"
#include "dbc/messages.hpp"

namespace lpvmpcd {

// Why it may not: it was not solved, or is not a plan of N = `horizon` steps of which every value is a number. kNone: it
// may.
[[nodiscard]] dbc::FaultCode Refusal(const control::Plan& plan, int horizon);

[[nodiscard]] dbc::SolverStatus ToBus(control::SolverStatus status);

}  // namespace lpvmpcd
