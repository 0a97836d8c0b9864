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

// What the vehicle is doing, from now on.
struct Present {
  std::span<const control::Input> plan;          // rest of the last plan; empty if there is none
  control::LateralPath beyond;                   // that plan leads on along it
  const control::StopPath* stop_path = nullptr;  // along which it can brake; null while the driver drives
  double acceleration = 0.0;                     // [m/s²]
};

// The first violation of a plan from the start that `check` was given, or what stands in the way of each stop behind it; and
// whether it rules the plan out. It does not if the last plan would fail no later, or if there is no clear stop anyway: then
// the new plan, made from newer data, is the lesser evil.
struct CheckVerdict {
  std::optional<control::ConstraintViolation> violation;
  bool ruled_out = false;
  bool stop_lasts = false;  // behind the plan, there is still a stop half a second later
};
[[nodiscard]] CheckVerdict CheckPlan(control::PlanCheck& check, const control::Plan& plan,
                                     const Present& present);

// True if there is a clear stop behind the rest of the last plan.
[[nodiscard]] bool StopsLater(control::PlanCheck& check, const Present& present);

// True if the vehicle must stop now: a stop is clear that begins at once, but none that begins later.
[[nodiscard]] bool StopIsDue(control::PlanCheck& check, const Present& present);

}  // namespace loop
