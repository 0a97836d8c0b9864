#include "loop/control_loop.hpp"

#include <algorithm>
#include <utility>

#include "control/road/keep_out.hpp"
#include "loop/plan_verdict.hpp"
#include "loop/report_frames.hpp"
#include "loop/route_place.hpp"

namespace loop {
namespace {

constexpr std::uint8_t kNoState = 15;
constexpr int kNoPlanAge = 63;
constexpr std::size_t kCommands = 2;
constexpr std::size_t kReports = 5;  // status, health, diagnostics, constraint, header of the horizon
constexpr int kShareForIterations =
    4;  // of the deadline, that may have passed before another iteration begins
constexpr int kPeriodsOfSilence = 40;  // without a command, after which others have the vehicle

}  // namespace

ControlLoop::ControlLoop(const LoopSettings& settings, const bus::VehicleBus& bus,
                         control::Controller& controller, const control::TimeReference& reference,
                         const control::RoadBounds& road, std::function<base::Time()> stopwatch,
                         control::PlanCheck* check)
    : settings_(settings),
      controller_(&controller),
      reference_(&reference),
      road_(road),
      stopwatch_(std::move(stopwatch)),
      check_(check),
      monitor_(bus, settings.monitor, settings.period),
      states_(settings.period),
      limiter_(settings.limits),
      gate_(bus),
      plan_(controller.horizon()),
      stop_({.vehicle = settings.vehicle, .t_s = base::ToSeconds(settings.period)}, reference),
      delay_(settings.vehicle, base::ToSeconds(settings.period), base::ToSeconds(settings.command_delay)),
      time_left_([this] { return stopwatch_() - cycle_start_ < settings_.deadline / kShareForIterations; }) {
  const int horizon = controller.horizon();
  settings_.limits.max_age = std::min(settings.limits.max_age, horizon - 1);
  limiter_ = safety::CommandLimiter(settings_.limits);
  const auto points = static_cast<std::size_t>(horizon) + 1;
  window_.resize(points);
  moved_.reserve(ObstacleAssembler::kMaxObstacles);
  frames_.reserve(kCommands + kReports + points);
}

void ControlLoop::Reconfigure(const LoopSettings& settings) {
  monitor_.Reconfigure(settings.monitor);
  const safety::CommandLimits limits = settings_.limits;  // with the max_age that the controller can do
  settings_ = settings;
  settings_.limits = limits;
}

bool ControlLoop::Receive(const can::Frame& frame, base::Time now) {
  // 1. The monitor: a frame that fails changes no value.
  const auto verdict = monitor_.Check(frame, now);
  const auto* accepted = std::get_if<safety::Accepted>(&verdict);
  if (accepted == nullptr) {
    return false;
  }

  // 2. What it tells goes where it belongs.
  const bus::Message& message = accepted->message;
  bool complete = false;
  if (const auto* pose = std::get_if<bus::VehiclePose>(&message)) {
    complete = states_.Update(*pose, accepted->counter, now);
  } else if (const auto* motion = std::get_if<bus::VehicleMotion>(&message)) {
    complete = states_.Update(*motion, accepted->counter, now);
  } else if (const auto* feedback = std::get_if<bus::VehicleFeedback>(&message)) {
    complete = states_.Update(*feedback, accepted->counter, now);
  } else if (const auto* position = std::get_if<bus::ObstaclePosition>(&message)) {
    obstacles_.Update(*position);
  } else if (const auto* shape = std::get_if<bus::ObstacleShape>(&message)) {
    obstacles_.Update(*shape);
  } else if (const auto* velocity = std::get_if<bus::ObstacleMotion>(&message)) {
    obstacles_.Update(*velocity);
  } else if (const auto* list = std::get_if<bus::ObstacleList>(&message)) {
    static_cast<void>(obstacles_.Update(*list, now));  // a list that does not fit lets the obstacles go stale
  } else if (const auto* request = std::get_if<bus::DriverRequest>(&message)) {
    // Between two cycles a touch of the brake or of the switch must not be lost.
    override_seen_ = override_seen_ || request->brake || request->steering_override;
    released_ = released_ || !request->engage;
    request_ = *request;
  }

  // 3. A complete state set asks for a cycle.
  if (complete) {
    trigger_time_ = now;
    steps_.CountState(states_.state().counter);  // here, so that a set counts that no cycle answers
  }
  return complete;
}

std::span<const can::Frame> ControlLoop::Cycle(base::Time now, Trigger trigger) {
  cycle_start_ = stopwatch_();
  const base::Time waited = trigger == Trigger::kState ? now - trigger_time_ : base::Time{0};
  report_.previous_mode = mode_.mode;
  report_.solver = bus::SolverStatus::kNone;
  report_.iterations = 0;
  report_.plan_accepted = false;
  report_.relaxation = {};
  report_.rejection = {};
  solve_ = nullptr;

  // 1. Time: which step it is, by the counter of the state (Receive) or, without a state, by the timer.
  if (trigger == Trigger::kTimer) {
    steps_.CountTimer();
  }

  // 2. What is known: health of the inputs, the driver's wish, the place on the route.
  safety::ModeInputs inputs = Judge(now, trigger);
  const bool asked =
      mode_.mode == bus::Mode::kStandby && inputs.state_new && safety::RisingEdge(mode_, inputs);

  // 3. The plan: a new one from a new state; without one, or if it is late or refused, the last plan goes on.
  const bool engaging = safety::EngagementRequested(mode_, inputs);
  const bool driving = bus::Drives(mode_.mode);
  TrackVehicle(inputs, engaging);
  if (waited <= settings_.deadline &&
      (engaging || (driving && inputs.state_new && inputs.state_fresh && inputs.route_left > 0))) {
    Solve(now, engaging);
  }
  const base::Time elapsed = stopwatch_() - cycle_start_;
  const base::Time age = waited + elapsed;
  const bool late = age > settings_.deadline;
  step_ = steps_.step() + (late ? age / settings_.period : 0);
  JudgePlan(late);
  if (engaging || driving) {
    inputs.plan_fault = PlanFault(inputs, late);
  }
  inputs.plan_usable = plan_.Covers(step_);
  inputs.plan_left = plan_.Left(step_);

  // 4. The mode.
  mode_ = Next(mode_, inputs, settings_.modes);

  // 5. The command, 6. the limiter, 7. the gate: what one of them refuses is never sent.
  const Trigger answered = late ? Trigger::kTimer : trigger;
  safety::LimitResult limited = Command();
  if (!limited.command || !Emit(*limited.command, answered)) {
    inputs.internal_error = true;
    mode_ = Next(mode_, inputs, settings_.modes);
    limited = Measured();
    static_cast<void>(Emit(*limited.command, answered));
  }
  if (bus::Commands(mode_.mode)) {
    applied_ = limited.command->u();
    delay_.Given(applied_);
  } else {
    plan_.Drop();  // whoever engages next begins with a plan of his own
  }

  // 8. What to tell about it, after the commands, so that these are on the bus soonest.
  report_.deadline_misses += late ? 1 : 0;
  report_.cycles += 1;
  report_.mode = mode_.mode;
  report_.cause = mode_.cause;
  report_.fault = Fault(inputs);
  report_.engagement_refused = asked && mode_.mode == bus::Mode::kStandby;
  report_.plan_age = plan_.exists() ? plan_.Age(step_) : -1;
  report_.countdown = Countdown(inputs);
  report_.faulty_message = safety::FindFaultyMessage(monitor_, now);
  report_.limited = limited.status == safety::LimitStatus::kLimited;
  report_.command = limited.command->u();
  report_.step_time = elapsed;
  EmitReports();

  released_ = false;
  override_seen_ = false;
  return frames_;
}

std::span<const can::Frame> ControlLoop::Disable() {
  if (bus::Commands(mode_.mode)) {
    mode_ = {.mode = bus::Mode::kStandby, .cause = safety::Cause::kReleased};
  }
  plan_.Drop();
  static_cast<void>(Emit(*Measured().command, Trigger::kTimer));
  return frames_;
}

std::span<const can::Frame> ControlLoop::Announce() {
  frames_.clear();
  AppendStatus(report_, gate_, frames_);
  return frames_;
}

safety::ModeInputs ControlLoop::Judge(base::Time now, Trigger trigger) {
  const VehicleState& state = states_.state();
  if (!bus::Commands(mode_.mode) && state.complete) {
    applied_ = state.feedback;
    delay_.Reset(applied_);
  }
  safety::ModeInputs inputs;
  inputs.bus_up = bus_up_;
  inputs.silent = now - last_sent_ > kPeriodsOfSilence * settings_.period;
  if (bus_up_) {
    last_sent_ = now;
  }
  inputs.state_new = trigger == Trigger::kState;
  inputs.state_fresh =
      state.complete && now - state.timestamp <= monitor_.StaleAfter(safety::RxMessage::kPose);
  inputs.state_rejected = monitor_.RecentlyRejected(safety::RxMessage::kPose, now) ||
                          monitor_.RecentlyRejected(safety::RxMessage::kMotion, now) ||
                          monitor_.RecentlyRejected(safety::RxMessage::kFeedback, now);
  inputs.obstacles_fresh = obstacles_.Age(now) <= monitor_.StaleAfter(safety::RxMessage::kObstacleList);
  inputs.request_fresh = monitor_.Fresh(safety::RxMessage::kDriverRequest, now);
  inputs.engage = request_.engage;
  inputs.released = released_;
  inputs.override_seen = override_seen_ || request_.brake || request_.steering_override;
  const double speed = state.z[control::kUpsilon];
  inputs.standstill = inputs.state_fresh && speed < settings_.standstill_speed;

  bool on_route = bus::Commands(mode_.mode);
  if (!on_route && inputs.state_fresh) {
    const auto place = FindOnRoute(*reference_, road_, state.z, settings_.engage_max_heading_error);
    on_route = place.has_value();
    route_start_ = steps_.step() - place.value_or(0);
  }
  if (settings_.by_progress && bus::Commands(mode_.mode)) {
    route_start_ = steps_.step() - stop_.place();
  }
  const std::int64_t k = steps_.step() - route_start_;
  report_.route_index = on_route ? static_cast<int>(k) : -1;
  inputs.near_route = on_route && speed >= settings_.engage_min_speed;
  if (settings_.by_progress) {
    const bool arrived = inputs.standstill && AtRouteEnd();
    inputs.route_left = on_route && !arrived ? std::max<std::int64_t>(reference_->size() - k, 1) : 0;
  } else {
    inputs.route_left = on_route ? reference_->size() - controller_->horizon() - k : 0;
  }
  return inputs;
}

bool ControlLoop::AtRouteEnd() const {
  constexpr double kWithin = 2.0;  // [m]
  const control::State& end = (*reference_)[reference_->size() - 1];
  return (states_.state().z - end).head<2>().norm() < kWithin;
}

void ControlLoop::TrackVehicle(const safety::ModeInputs& inputs, bool engaging) {
  const control::State& z = states_.state().z;
  if (engaging) {
    stop_.Start(z, report_.route_index);
  } else if (bus::Commands(mode_.mode)) {
    stop_.Advance(inputs.state_new && inputs.state_fresh ? &z : nullptr, applied_);
  }
}

void ControlLoop::Solve(base::Time now, bool engaging) {
  if (engaging) {
    controller_->Reset();
    if (check_ != nullptr) check_->Reset();
  }
  // All as it will be when the command acts.
  const VehicleState& state = states_.state();
  z_ = delay_.Ahead(state.z, base::ToSeconds(now - state.timestamp));
  moved_.assign(obstacles_.obstacles().begin(), obstacles_.obstacles().end());
  for (control::Obstacle& obstacle : moved_) {
    obstacle = control::Predict(obstacle, base::ToSeconds(obstacles_.Age(now)) + delay_.delay());
  }
  reference_->Window(static_cast<int>(steps_.step() - route_start_), window_);
  const double psi = window_.front()[control::kPsi];
  z_[control::kPsi] = psi + control::WrapAngle(z_[control::kPsi] - psi);
  const control::Plan& plan = controller_->Step({.z = z_,
                                                 .u_previous = applied_,
                                                 .reference = window_,
                                                 .road = road_,
                                                 .obstacles = moved_,
                                                 .time_left = &time_left_});
  solve_ = &plan;
  report_.solver = ToBus(plan.status);
  report_.iterations = plan.iterations;
  if (plan.status != control::SolverStatus::kSolved) {
    report_.relaxation = controller_->DiagnoseInfeasibility();
  } else if (plan.relaxation.amount > 0.0) {
    report_.relaxation = plan.relaxation;
  }
}

void ControlLoop::JudgePlan(bool late) {
  if (solve_ == nullptr) {
    return;
  }
  bus::FaultCode refusal = late ? bus::FaultCode::kDeadlineMissed : Refusal(*solve_, controller_->horizon());
  if (refusal == bus::FaultCode::kNone && check_ != nullptr) {
    const CheckVerdict verdict = CheckPlan(*check_, z_, solve_->u, plan_.From(steps_.step()), moved_);
    report_.rejection = verdict.violation;
    if (verdict.ruled_out) refusal = bus::FaultCode::kPlanRejected;
  }
  report_.plan_accepted = refusal == bus::FaultCode::kNone;
  if (report_.plan_accepted) {
    plan_.Take(*solve_, steps_.step());
    stop_.Follow(solve_->z);
  } else {
    ++report_.plans_refused;
    report_.last_refusal = refusal;
  }
}

safety::LimitResult ControlLoop::Command() const {
  if (bus::Drives(mode_.mode)) {
    return limiter_.Limit(plan_.At(step_), applied_, plan_.Age(step_));
  }
  if (mode_.mode == bus::Mode::kSafeStop) {
    // Along the rest of the last plan, then along its path; never snapped to zero.
    const double delta =
        plan_.Covers(step_) ? plan_.At(step_)[control::kDelta] : stop_.Steering(applied_[control::kDelta]);
    return limiter_.Limit({delta, -settings_.stop_deceleration}, applied_, 0);
  }
  return Measured();
}

safety::LimitResult ControlLoop::Measured() const {
  // Not enabled, the commands follow the vehicle, so that enabling them later is no jump.
  const control::Input& feedback = states_.state().feedback;
  return limiter_.Limit(feedback, feedback, 0);
}

std::optional<safety::Cause> ControlLoop::PlanFault(const safety::ModeInputs& inputs, bool late) const {
  if (report_.plan_accepted) return std::nullopt;
  if (late) return safety::Cause::kDeadlineMissed;
  if (solve_ == nullptr) return inputs.state_new ? std::nullopt : std::optional(safety::Cause::kStateLate);
  return solve_->status == control::SolverStatus::kSolved ? safety::Cause::kPlanRejected
                                                          : safety::Cause::kSolverFailed;
}

bus::FaultCode ControlLoop::Fault(const safety::ModeInputs& inputs) const {
  const bool stopped = mode_.mode == bus::Mode::kSafeStop || mode_.mode == bus::Mode::kFault;
  const auto cause = stopped ? mode_.cause : safety::PresentFault(inputs);
  if (cause) return *cause == safety::Cause::kSolverFailed ? report_.last_refusal : safety::FaultOf(*cause);
  if (mode_.mode == bus::Mode::kStandby && inputs.near_route && inputs.route_left <= 0)
    return bus::FaultCode::kRouteEnd;
  if (mode_.mode == bus::Mode::kStandby && !inputs.near_route) return bus::FaultCode::kOffRoute;
  return bus::FaultCode::kNone;
}

base::Time ControlLoop::Countdown(const safety::ModeInputs& inputs) const {
  if (mode_.mode == bus::Mode::kSafeStop) return base::Time{0};
  if (!bus::Drives(mode_.mode)) return base::Time::max();
  std::int64_t cycles = inputs.route_left;
  if (mode_.mode == bus::Mode::kDegraded) {
    cycles = std::min<std::int64_t>(cycles, mode_.degraded_left);
    if (inputs.plan_fault) cycles = std::min<std::int64_t>(cycles, inputs.plan_left);
  }
  return cycles * settings_.period;
}

bool ControlLoop::Emit(const safety::LimitedCommand& command, Trigger trigger) {
  const int age = plan_.exists() ? plan_.Age(step_) : kNoPlanAge;
  const safety::Answer answer{
      .mode = mode_.mode,
      .state_counter = trigger == Trigger::kState ? states_.state().counter : kNoState,
      .plan_age = static_cast<std::uint8_t>(std::min(age, kNoPlanAge))};
  frames_.resize(kCommands);
  if (!gate_.Encode(command, answer, std::span<can::Frame, kCommands>(frames_))) {
    frames_.clear();
    return false;
  }
  return true;
}

void ControlLoop::EmitReports() {
  AppendStatus(report_, gate_, frames_);
  AppendHealth(solve_, gate_, frames_);
  AppendDiagnostics(report_, mode_, gate_, frames_);
  AppendConstraint(report_, gate_, frames_);
  if (settings_.send_horizon && report_.plan_accepted) {
    AppendHorizon(*solve_, states_.state().counter, settings_.period, gate_, frames_);
  }
}

}  // namespace loop
