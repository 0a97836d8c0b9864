// Decides whether a plan may be followed, and maps the result to the bus's codes.
#pragma once

#include <optional>
#include <span>

#include "bus/messages.hpp"
#include "control/mpc/constraint.hpp"
#include "control/mpc/controller.hpp"
#include "control/mpc/plan_check.hpp"

namespace loop {

// A solver's status on the bus, and its fault code.
struct SolverOutcome {
  bus::SolverStatus status = bus::SolverStatus::kSolved;
  bus::FaultCode fault = bus::FaultCode::kNone;
};
[[nodiscard]] SolverOutcome OnBus(control::SolverStatus status);

// Why a plan must not be followed: it was not solved, or it is not a plan of N = `horizon` steps with finite values.
// kNone if it may be followed.
[[nodiscard]] bus::FaultCode Refusal(const control::Plan& plan, int horizon);

// The first violation of a plan from the start that `check` was given, and whether it rules the plan out. It does not if the last
// plan would fail no later: then the new plan, made from newer data, is the lesser evil. `last`: the inputs of the last
// plan from now on; empty if there is none, in which case any violation rules out the new plan.
struct CheckVerdict {
  std::optional<control::ConstraintViolation> violation;
  bool ruled_out = false;
};
[[nodiscard]] CheckVerdict CheckPlan(const control::PlanCheck& check, std::span<const control::Input> plan,
                                     std::span<const control::Input> last);

}  // namespace loop
