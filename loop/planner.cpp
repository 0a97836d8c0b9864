#include "loop/planner.hpp"

#include <utility>

#include "control/road/keep_out.hpp"
#include "loop/plan_verdict.hpp"

namespace loop {
namespace {

constexpr int kShareForIterations = 4;  // another iteration may begin within 1/4 of the deadline

// The reason why a cycle that should have a new plan has none, or none from a new state.
std::optional<safety::Cause> FaultOf(const Outcome& outcome, bool state_new) {
  using safety::Cause;
  if (outcome.late) return Cause::kDeadlineMissed;
  if (outcome.accepted || outcome.solution == nullptr)
    return state_new ? std::nullopt : std::optional(Cause::kStateLate);
  return outcome.solution->status == control::SolverStatus::kSolved ? Cause::kPlanRejected
                                                                    : Cause::kSolverFailed;
}

}  // namespace

Planner::Planner(const PlannerSettings& settings, control::Controller& controller,
                 std::function<base::Time()> stopwatch, control::PlanCheck* check)
    : settings_(settings),
      controller_(&controller),
      stopwatch_(std::move(stopwatch)),
      check_(check),
      time_left_([this] { return stopwatch_() - start_ < settings_.deadline / kShareForIterations; }),
      delay_(settings.vehicle, base::ToSeconds(settings.period), base::ToSeconds(settings.command_delay)),
      active_(controller.horizon()) {
  if (settings.offset_free)
    estimator_.emplace(settings.vehicle, control::EstimatorSettings{.mu = settings.mu});
  obstacles_.reserve(ObstacleAssembler::kMaxObstacles);
}

Outcome Planner::Plan(PlanRequest request, const Snapshot& known, const control::RoutePlace& place,
                      bool commanding, const control::Input& applied) {
  if (commanding) {
    delay_.Record(applied);
  } else {
    delay_.Reset(applied);
  }
  Estimate(known);
  Outcome outcome;
  Prediction prediction{.z = control::State::Zero(), .obstacles = {}};
  if (request == PlanRequest::kFirst) {
    controller_->Reset();
  }
  const bool due = request == PlanRequest::kFirst || request == PlanRequest::kNext;
  if (due && known.waited <= settings_.deadline) {
    prediction = Predict(known);
    outcome.solution = &controller_->Step({.z = prediction.z,
                                           .u_previous = applied,
                                           .place = place,
                                           .obstacles = prediction.obstacles,
                                           .disturbance = disturbance(),
                                           .mu_limit = mu_limit(),
                                           .time_left = &time_left_});
    outcome.relaxation = Unmet(*outcome.solution);
  }
  outcome.solve_time = stopwatch_() - start_;
  const base::Time age = known.waited + outcome.solve_time;
  outcome.late = age > settings_.deadline;
  outcome.step = known.step + (outcome.late ? age / settings_.period : 0);
  if (outcome.solution != nullptr) {
    Accept(known, place, prediction, outcome);
  }
  if (request != PlanRequest::kNone) {
    outcome.fault = FaultOf(outcome, known.state_new);
  }
  return outcome;
}

// States follow each other by their counters, not by their time stamps, which the bus delays.
void Planner::Estimate(const Snapshot& known) {
  if (!estimator_ || !known.state_new) return;
  const base::Time since = (known.step - estimated_step_) * settings_.period;
  estimator_->Update(known.state.z, known.state.feedback, base::ToSeconds(since));
  estimated_step_ = known.step;
}

Planner::Prediction Planner::Predict(const Snapshot& known) {
  obstacles_.assign(known.obstacles.begin(), known.obstacles.end());
  for (control::Obstacle& obstacle : obstacles_) {
    obstacle = control::Predict(obstacle, base::ToSeconds(known.obstacle_age) + delay_.delay());
  }
  const double age = base::ToSeconds(known.now - known.state.timestamp);
  return {.z = delay_.Predict(known.state.z, age, disturbance()), .obstacles = obstacles_};
}

std::optional<control::ConstraintViolation> Planner::Unmet(const control::Plan& plan) const {
  if (plan.status != control::SolverStatus::kSolved) return controller_->DiagnoseInfeasibility();
  if (plan.relaxation.amount > 0.0) return plan.relaxation;
  return std::nullopt;
}

void Planner::Accept(const Snapshot& known, const control::RoutePlace& place, const Prediction& prediction,
                     Outcome& outcome) {
  const control::Plan& plan = *outcome.solution;
  bus::FaultCode refusal =
      outcome.late ? bus::FaultCode::kDeadlineMissed : Refusal(plan, controller_->horizon());
  if (refusal == bus::FaultCode::kNone && check_ != nullptr) {
    check_->Begin(prediction.z, place.s, prediction.obstacles, disturbance(), mu_limit());
    const CheckVerdict verdict = CheckPlan(*check_, plan.u, active_.From(known.step));
    outcome.rejection = verdict.violation;
    if (verdict.ruled_out) refusal = bus::FaultCode::kPlanRejected;
  }
  outcome.accepted = refusal == bus::FaultCode::kNone;
  if (outcome.accepted) {
    active_.Set(plan, known.step);
  } else {
    ++refused_;
    last_refusal_ = refusal;
  }
}

}  // namespace loop
