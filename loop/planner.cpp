#include "loop/planner.hpp"

#include <algorithm>
#include <utility>

#include "control/road/keep_out.hpp"

namespace loop {
namespace {

constexpr double kHalfWidth = 1.0;      // of a vehicle that is not known [m]
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
                 const control::RoadProfile& profile, std::function<base::Time()> stopwatch,
                 control::PlanCheck* check)
    : settings_(settings),
      controller_(&controller),
      stopwatch_(std::move(stopwatch)),
      check_(check),
      time_left_([this] { return stopwatch_() - start_ < settings_.deadline / kShareForIterations; }),
      delay_(settings.vehicle, base::ToSeconds(settings.period), base::ToSeconds(settings.command_delay)),
      active_(controller.horizon()),
      stop_path_(settings.vehicle, profile, controller.horizon(),
                 check != nullptr ? check->footprint().half_width : kHalfWidth) {
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
  const Prediction prediction = request == PlanRequest::kNone
                                    ? Prediction{.z = control::State::Zero(), .obstacles = {}}
                                    : Predict(known);
  if (request == PlanRequest::kFirst) {
    controller_->Reset();
  }
  const bool due = request == PlanRequest::kFirst || request == PlanRequest::kNext;
  if (due && known.waited <= settings_.deadline) {
    outcome.solution = &controller_->Step({.z = prediction.z,
                                           .u_previous = applied,
                                           .place = place,
                                           .obstacles = prediction.obstacles,
                                           .disturbance = disturbance(),
                                           .mu_limit = mu_limit(),
                                           .slow_down = slow_down_,
                                           .time_left = &time_left_});
    outcome.relaxation = Unmet(*outcome.solution);
  }
  outcome.solve_time = stopwatch_() - start_;
  const base::Time age = known.waited + outcome.solve_time;
  outcome.late = age > settings_.deadline;
  outcome.step = known.step + (outcome.late ? age / settings_.period : 0);
  if (check_ != nullptr && request != PlanRequest::kNone)
    check_->Begin(prediction.z, place.s, prediction.obstacles, disturbance(), mu_limit());
  const Present present{.plan = active_.From(known.step),
                        .beyond = active_.beyond(),
                        .stop_path = commanding ? &stop_path_ : nullptr,
                        .acceleration = applied[control::kAcceleration]};
  if (outcome.solution != nullptr) Accept(known, place, present, outcome);
  if (check_ != nullptr && commanding && known.state_fresh && !outcome.accepted)
    outcome.stop_due = StopIsDue(*check_, present);
  if (request != PlanRequest::kNone) {
    outcome.fault = FaultOf(outcome, known.state_new);
  }
  return outcome;
}

void Planner::Reconfigure(double stop_deceleration) {
  settings_.stop_deceleration = stop_deceleration;
  if (check_ != nullptr) check_->Reconfigure(stop_deceleration);
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

void Planner::Accept(const Snapshot& known, const control::RoutePlace& place, const Present& present,
                     Outcome& outcome) {
  const control::Plan& plan = *outcome.solution;
  bool stop_lasts = true;
  bus::FaultCode refusal =
      outcome.late ? bus::FaultCode::kDeadlineMissed : Refusal(plan, controller_->horizon());
  if (refusal == bus::FaultCode::kNone && check_ != nullptr) {
    const CheckVerdict verdict = CheckPlan(*check_, plan, present);
    outcome.rejection = verdict.violation;
    stop_lasts = verdict.stop_lasts;
    if (verdict.ruled_out) refusal = bus::FaultCode::kPlanRejected;
  }
  outcome.accepted = refusal == bus::FaultCode::kNone;
  slow_down_ = !stop_lasts;
  if (outcome.accepted) {
    active_.Set(plan, known.step);
    stop_path_.Follow(plan.z, place.s, plan.beyond);
  } else {
    ++refused_;
    last_refusal_ = refusal;
  }
}

control::Input Planner::StopInput(const Snapshot& known, const control::RoutePlace& place,
                                  const control::RouteMotion& motion, const control::Input& applied) {
  constexpr double kSteeringRate = 0.5;  // for the transition of δ from the last plan to the path [rad/s]
  const double change = kSteeringRate * base::ToSeconds(settings_.period);
  const double last = applied[control::kDelta];
  control::Input stop(last, -settings_.stop_deceleration);
  if (motion.speed > control::kMinSteeringSpeed)
    stop[control::kDelta] = std::clamp(stop_path_.Steering(motion, place.s), last - change, last + change);
  if (check_ == nullptr) return stop;
  if (!known.state_fresh) {
    control::State reckoned;
    reckoned << motion.p, motion.speed, 0.0, motion.psi, 0.0;
    check_->Begin(reckoned, place.s, obstacles_, disturbance(), mu_limit());
  }
  const auto now = check_->FindStop(stop_path_, applied[control::kAcceleration]).deceleration;
  if (!now && StopsLater(*check_, {.plan = active_.From(known.step), .beyond = active_.beyond()}))
    return active_.At(known.step);
  stop[control::kAcceleration] = -check_->Deceleration(stop_path_, now);
  return stop;
}

}  // namespace loop
