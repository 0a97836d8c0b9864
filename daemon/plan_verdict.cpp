#include "daemon/plan_verdict.hpp"

#include <algorithm>
#include <cstddef>

namespace lpvmpcd {
namespace {

// Of a plan that was solved: every value of it is a number.
bool Acceptable(const control::Plan& plan, int horizon) {
  const auto n = static_cast<std::size_t>(horizon);
  return plan.u.size() == n && plan.z.size() == n + 1 &&
         std::ranges::all_of(plan.u, [](const control::Input& u) { return u.allFinite(); }) &&
         std::ranges::all_of(plan.z, [](const control::State& z) { return z.allFinite(); });
}

}  // namespace

dbc::FaultCode Refusal(const control::Plan& plan, int horizon) {
  switch (plan.status) {
    case control::SolverStatus::kSolved:
      return Acceptable(plan, horizon) ? dbc::FaultCode::kNone : dbc::FaultCode::kPlanRejected;
    case control::SolverStatus::kInfeasible:
      return dbc::FaultCode::kSolverInfeasible;
    case control::SolverStatus::kIterationLimit:
      return dbc::FaultCode::kSolverIterationLimit;
    case control::SolverStatus::kNumericalFailure:
      break;
  }
  return dbc::FaultCode::kSolverNumericalFailure;
}

CheckVerdict CheckPlan(control::PlanCheck& check, const control::State& z,
                       std::span<const control::Input> plan, std::span<const control::Input> last,
                       std::span<const control::Obstacle> obstacles) {
  CheckVerdict verdict{.violation = check.Judge(z, plan, obstacles), .ruled_out = false};
  if (!verdict.violation) return verdict;
  const auto of_last = check.Judge(z, last, obstacles);
  verdict.ruled_out = !of_last || of_last->constraint.step > verdict.violation->constraint.step;
  return verdict;
}

dbc::SolverStatus ToBus(control::SolverStatus status) {
  switch (status) {
    case control::SolverStatus::kSolved:
      return dbc::SolverStatus::kSolved;
    case control::SolverStatus::kInfeasible:
      return dbc::SolverStatus::kInfeasible;
    case control::SolverStatus::kIterationLimit:
      return dbc::SolverStatus::kIterationLimit;
    case control::SolverStatus::kNumericalFailure:
      break;
  }
  return dbc::SolverStatus::kNumericalFailure;
}

}  // namespace lpvmpcd
