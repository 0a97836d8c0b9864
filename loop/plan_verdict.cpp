#include "loop/plan_verdict.hpp"

#include <algorithm>
#include <cstddef>

namespace loop {
namespace {

// True if a solved plan has N = `horizon` steps and all its values are finite.
bool Acceptable(const control::Plan& plan, int horizon) {
  const auto n = static_cast<std::size_t>(horizon);
  return plan.u.size() == n && plan.z.size() == n + 1 &&
         std::ranges::all_of(plan.u, [](const control::Input& u) { return u.allFinite(); }) &&
         std::ranges::all_of(plan.z, [](const control::State& z) { return z.allFinite(); });
}

// True if a stop is clear that begins at once.
bool StopsNow(const control::PlanCheck& check, const Present& present) {
  return present.stop_path != nullptr &&
         check.FindStop(*present.stop_path, present.acceleration).deceleration.has_value();
}

}  // namespace

SolverOutcome OnBus(control::SolverStatus status) {
  switch (status) {
    case control::SolverStatus::kSolved:
      return {bus::SolverStatus::kSolved, bus::FaultCode::kNone};
    case control::SolverStatus::kInfeasible:
      return {bus::SolverStatus::kInfeasible, bus::FaultCode::kSolverInfeasible};
    case control::SolverStatus::kIterationLimit:
      return {bus::SolverStatus::kIterationLimit, bus::FaultCode::kSolverIterationLimit};
    case control::SolverStatus::kNumericalFailure:
      break;
  }
  return {bus::SolverStatus::kNumericalFailure, bus::FaultCode::kSolverNumericalFailure};
}

bus::FaultCode Refusal(const control::Plan& plan, int horizon) {
  const bus::FaultCode fault = OnBus(plan.status).fault;
  if (fault != bus::FaultCode::kNone) return fault;
  return Acceptable(plan, horizon) ? bus::FaultCode::kNone : bus::FaultCode::kPlanRejected;
}

CheckVerdict CheckPlan(control::PlanCheck& check, const control::Plan& plan, const Present& present) {
  const auto violation = check.Validate(plan.u);
  const control::StopVerdict behind = check.FindStop(plan.beyond);
  CheckVerdict verdict{
      .violation = violation ? violation : behind.violation, .ruled_out = false, .stop_lasts = behind.lasts};
  if (!verdict.violation) return verdict;
  if (violation) {
    const auto of_last = check.Validate(present.plan);
    verdict.ruled_out = !of_last || of_last->constraint.step > violation->constraint.step;
  }
  if (!behind.deceleration) {
    verdict.ruled_out = verdict.ruled_out || StopsLater(check, present) || StopsNow(check, present);
  }
  return verdict;
}

bool StopsLater(control::PlanCheck& check, const Present& present) {
  if (present.plan.empty()) return false;
  static_cast<void>(check.Validate(present.plan));
  return check.FindStop(present.beyond).deceleration.has_value();
}

bool StopIsDue(control::PlanCheck& check, const Present& present) {
  return !StopsLater(check, present) && StopsNow(check, present);
}

}  // namespace loop
