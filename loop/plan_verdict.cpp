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

CheckVerdict CheckPlan(const control::PlanCheck& check, std::span<const control::Input> plan,
                       std::span<const control::Input> last) {
  CheckVerdict verdict{.violation = check.Validate(plan), .ruled_out = false};
  if (!verdict.violation) return verdict;
  const auto of_last = check.Validate(last);
  verdict.ruled_out = !of_last || of_last->constraint.step > verdict.violation->constraint.step;
  return verdict;
}

}  // namespace loop
