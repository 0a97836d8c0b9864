// Whether a plan may be followed, and how the bus is told.
#pragma once

#include <optional>
#include <span>

#include "bus/messages.hpp"
#include "control/mpc/constraint.hpp"
#include "control/mpc/controller.hpp"
#include "control/mpc/plan_check.hpp"

namespace loop {

// How the bus names a solver's status, and the fault that it is.
struct SolverOutcome {
  bus::SolverStatus status = bus::SolverStatus::kSolved;
  bus::FaultCode fault = bus::FaultCode::kNone;
};
[[nodiscard]] SolverOutcome OnBus(control::SolverStatus status);

// Why it may not: it was not solved, or is not a plan of N = `horizon` steps of which every value is a number. kNone: it
// may.
[[nodiscard]] bus::FaultCode Refusal(const control::Plan& plan, int horizon);

// What goes wrong with a plan from `z` among `obstacles`, and whether that rules it out. It does not if going on with the
// last one goes wrong no later: then the new one, which knows better, is the lesser evil. `last`: its inputs from now on,
// empty if there is none, which rules the new one out.
struct CheckVerdict {
  std::optional<control::ConstraintViolation> violation;
  bool ruled_out = false;
};
[[nodiscard]] CheckVerdict CheckPlan(control::PlanCheck& check, const control::State& z,
                                     std::span<const control::Input> plan,
                                     std::span<const control::Input> last,
                                     std::span<const control::Obstacle> obstacles);

}  // namespace loop
