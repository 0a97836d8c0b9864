#include "daemon/control_loop.hpp"

#include <algorithm>
#include <utility>

#include "daemon/route_place.hpp"
#include "dbc/e2e.hpp"

namespace lpvmpcd {
namespace {

constexpr std::uint8_t kNoState = 15;
constexpr int kNoPlanAge = 63;
constexpr std::size_t kReports = 3;  // status, health, header of the horizon
constexpr std::size_t kCommands = 2;
constexpr std::size_t kMaxPoints = 127;  // of a horizon on the bus

// A plan is taken only if it was solved and every value of it is a number.
bool Acceptable(const control::Plan& plan, int horizon) {
  const auto n = static_cast<std::size_t>(horizon);
  return plan.status == control::SolverStatus::kSolved && plan.u.size() == n && plan.z.size() == n + 1 &&
         std::ranges::all_of(plan.u, [](const control::Input& u) { return u.allFinite(); }) &&
         std::ranges::all_of(plan.z, [](const control::State& z) { return z.allFinite(); });
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

}  // namespace

ControlLoop::ControlLoop(const LoopSettings& settings, const dbc::VehicleBus& bus,
                         control::Controller& controller, const control::Reference& reference,
                         const control::RoadBounds& road, std::function<Time()> stopwatch)
    : settings_(settings),
      controller_(&controller),
      reference_(&reference),
      road_(road),
      stopwatch_(std::move(stopwatch)),
      monitor_(bus, settings.monitor, settings.period),
      limiter_(settings.limits),
      gate_(bus) {
  const int horizon = controller.horizon();
  settings_.limits.max_age = std::min(settings.limits.max_age, horizon - 1);
  limiter_ = control::CommandLimiter(settings_.limits);
  const auto points = static_cast<std::size_t>(horizon) + 1;
  window_.resize(points);
  plan_.reserve(points);
  frames_.reserve(kCommands + kReports + points);
}

bool ControlLoop::Receive(const can::Frame& frame, Time now) {
  // 1. The monitor: a frame that fails changes no value.
  const auto verdict = monitor_.Check(frame, now);
  const auto* accepted = std::get_if<Accepted>(&verdict);
  if (accepted == nullptr) {
    return false;
  }

  // 2. What it tells goes where it belongs.
  const dbc::Message& message = accepted->message;
  bool complete = false;
  if (const auto* pose = std::get_if<dbc::VehiclePose>(&message)) {
    complete = states_.Update(*pose, accepted->counter, now);
  } else if (const auto* motion = std::get_if<dbc::VehicleMotion>(&message)) {
    complete = states_.Update(*motion, accepted->counter, now);
  } else if (const auto* feedback = std::get_if<dbc::VehicleFeedback>(&message)) {
    complete = states_.Update(*feedback, accepted->counter, now);
  } else if (const auto* position = std::get_if<dbc::ObstaclePosition>(&message)) {
    obstacles_.Update(*position);
  } else if (const auto* shape = std::get_if<dbc::ObstacleShape>(&message)) {
    obstacles_.Update(*shape);
  } else if (const auto* velocity = std::get_if<dbc::ObstacleMotion>(&message)) {
    obstacles_.Update(*velocity);
  } else if (const auto* list = std::get_if<dbc::ObstacleList>(&message)) {
    static_cast<void>(obstacles_.Update(*list, now));  // a list that does not fit lets the obstacles go stale
  } else if (const auto* request = std::get_if<dbc::DriverRequest>(&message)) {
    // Between two cycles a touch of the brake or of the switch must not be lost.
    override_seen_ = override_seen_ || request->brake || request->steering_override;
    released_ = released_ || !request->engage;
    request_ = *request;
  }

  // 3. A complete state set asks for a cycle.
  if (complete) {
    trigger_time_ = now;
  }
  return complete;
}

std::span<const can::Frame> ControlLoop::Cycle(Time now, Trigger trigger) {
  const Time start = stopwatch_();
  report_.previous_mode = mode_.mode;
  report_.solver = dbc::SolverStatus::kNone;
  report_.plan_accepted = false;
  new_plan_ = nullptr;
  last_solve_ = nullptr;

  // 1. Time: which step it is, by the counter of the state or, without a state, by the timer.
  CountStep(trigger);
  if (!Commands(mode_.mode) && states_.state().complete) {
    applied_ = states_.state().feedback;
  }

  // 2. What is known: health of the inputs, the driver's wish, the place on the route.
  ModeInputs inputs = Judge(now, trigger);

  const bool asked = mode_.mode == Mode::kStandby && inputs.state_new && RisingEdge(mode_, inputs);

  // 3. The plan: a new one from a new state; without one, or if it is refused, the last plan goes on.
  const bool engaging = EngagementRequested(mode_, inputs);
  if (engaging ||
      (mode_.mode == Mode::kActive && inputs.state_new && inputs.state_fresh && !inputs.route_end)) {
    Solve(engaging);
  }
  inputs.plan_usable = PlanCoversNow();

  // 4. The mode.
  mode_ = Next(mode_, inputs);

  // 5. The command, 6. the limiter, 7. the gate: what one of them refuses is never sent.
  control::LimitResult limited = Command();
  if (!limited.command || !Emit(*limited.command, trigger)) {
    inputs.internal_error = true;
    mode_ = Next(mode_, inputs);
    limited = Measured();
    static_cast<void>(Emit(*limited.command, trigger));
  }
  if (Commands(mode_.mode)) {
    applied_ = limited.command->u();
  } else {
    plan_.clear();  // whoever engages next begins with a plan of his own
  }

  // 8. What to tell about it, after the commands, so that these are on the bus soonest.
  const Time elapsed = stopwatch_() - start;
  const Time waited = trigger == Trigger::kState ? now - trigger_time_ : Time{0};
  report_.deadline_misses += waited + elapsed > settings_.period ? 1 : 0;
  report_.cycles += 1;
  report_.mode = mode_.mode;
  report_.cause = mode_.cause;
  report_.fault = Fault(inputs);
  report_.engagement_refused = asked && mode_.mode == Mode::kStandby;
  report_.plan_age = plan_.empty() ? -1 : PlanAge();
  report_.limited = limited.status == control::LimitStatus::kLimited;
  report_.command = limited.command->u();
  report_.step_time = elapsed;
  EmitReports();

  released_ = false;
  override_seen_ = false;
  return frames_;
}

std::span<const can::Frame> ControlLoop::Disable() {
  if (Commands(mode_.mode)) {
    mode_ = {.mode = Mode::kStandby, .cause = Cause::kReleased};
  }
  plan_.clear();
  frames_.clear();
  static_cast<void>(Emit(*Measured().command, Trigger::kTimer));
  return frames_;
}

std::span<const can::Frame> ControlLoop::Announce() {
  frames_.clear();
  EmitStatus();
  return frames_;
}

void ControlLoop::CountStep(Trigger trigger) {
  if (trigger == Trigger::kTimer) {
    ++step_;
    return;
  }
  const int counter = states_.state().counter;
  std::int64_t step = step_ + 1;
  if (state_counter_ >= 0) {
    constexpr int kModulus = dbc::kCounterModulus;
    step = state_step_ + (counter + kModulus - state_counter_) % kModulus;
    // The counter tells the step modulo 15; of the possible ones, that which the timer counted roughly.
    while (step < step_ - kModulus / 2) {
      step += kModulus;
    }
  }
  step_ = step;
  state_step_ = step;
  state_counter_ = counter;
}

ModeInputs ControlLoop::Judge(Time now, Trigger trigger) {
  const VehicleState& state = states_.state();
  ModeInputs inputs;
  inputs.bus_up = bus_up_;
  inputs.state_new = trigger == Trigger::kState;
  inputs.state_fresh = state.complete && now - state.timestamp <= monitor_.StaleAfter(RxMessage::kPose);
  inputs.state_rejected = monitor_.RecentlyRejected(RxMessage::kPose, now) ||
                          monitor_.RecentlyRejected(RxMessage::kMotion, now) ||
                          monitor_.RecentlyRejected(RxMessage::kFeedback, now);
  inputs.obstacles_fresh = obstacles_.Age(now) <= monitor_.StaleAfter(RxMessage::kObstacleList);
  inputs.request_fresh = monitor_.Fresh(RxMessage::kDriverRequest, now);
  inputs.engage = request_.engage;
  inputs.released = released_;
  inputs.override_seen = override_seen_ || request_.brake || request_.steering_override;
  const double speed = state.z[control::kUpsilon];
  inputs.standstill = inputs.state_fresh && speed < settings_.standstill_speed;

  bool on_route = Commands(mode_.mode);
  if (!on_route && inputs.state_fresh) {
    const auto place = FindOnRoute(*reference_, road_, state.z, settings_.engage_max_heading_error);
    on_route = place.has_value();
    route_start_ = step_ - place.value_or(0);
  }
  const std::int64_t k = step_ - route_start_;
  report_.route_index = on_route ? static_cast<int>(k) : -1;
  inputs.near_route = on_route && speed >= settings_.engage_min_speed;
  inputs.route_end = on_route && k + controller_->horizon() >= reference_->size();
  return inputs;
}

void ControlLoop::Solve(bool engaging) {
  if (engaging) {
    controller_->Reset();
  }
  reference_->Window(static_cast<int>(step_ - route_start_), window_);
  control::State z = states_.state().z;
  const double psi = window_.front()[control::kPsi];
  z[control::kPsi] = psi + control::WrapAngle(z[control::kPsi] - psi);
  const control::Plan& plan = controller_->Step({.z = z,
                                                 .u_previous = applied_,
                                                 .reference = window_,
                                                 .road = road_,
                                                 .obstacles = obstacles_.obstacles()});
  last_solve_ = &plan;
  report_.solver = ToBus(plan.status);
  if (Acceptable(plan, controller_->horizon())) {
    new_plan_ = &plan;
    report_.plan_accepted = true;
    plan_.assign(plan.u.begin(), plan.u.end());
    plan_step_ = step_;
  } else {
    ++report_.solver_failures;
  }
}

control::LimitResult ControlLoop::Command() const {
  if (mode_.mode == Mode::kActive) {
    return limiter_.Limit(plan_[static_cast<std::size_t>(PlanAge())], applied_, PlanAge());
  }
  if (mode_.mode == Mode::kSafeStop) {
    // Along the rest of the last plan, then with the wheels held; never snapped to zero.
    const double delta = PlanCoversNow() ? plan_[static_cast<std::size_t>(PlanAge())][control::kDelta]
                                         : applied_[control::kDelta];
    return limiter_.Limit({delta, -settings_.stop_deceleration}, applied_, 0);
  }
  return Measured();
}

control::LimitResult ControlLoop::Measured() const {
  // Not enabled, the commands follow the vehicle, so that enabling them later is no jump.
  const control::Input& feedback = states_.state().feedback;
  return limiter_.Limit(feedback, feedback, 0);
}

dbc::FaultCode ControlLoop::Fault(const ModeInputs& inputs) const {
  using dbc::FaultCode;
  if (mode_.mode == Mode::kSafeStop || mode_.mode == Mode::kFault) return FaultOf(mode_.cause);
  if (!inputs.bus_up) return FaultCode::kBusDown;
  if (!inputs.state_fresh) return inputs.state_rejected ? FaultCode::kStateInvalid : FaultCode::kStateStale;
  if (!inputs.obstacles_fresh) return FaultCode::kObstaclesStale;
  if (!inputs.request_fresh) return FaultCode::kDriverRequestStale;
  if (last_solve_ != nullptr && new_plan_ == nullptr) {
    switch (last_solve_->status) {
      case control::SolverStatus::kInfeasible:
        return FaultCode::kSolverInfeasible;
      case control::SolverStatus::kIterationLimit:
        return FaultCode::kSolverIterationLimit;
      case control::SolverStatus::kSolved:
      case control::SolverStatus::kNumericalFailure:
        return FaultCode::kSolverNumericalFailure;
    }
  }
  if (mode_.mode == Mode::kStandby && inputs.route_end) return FaultCode::kRouteEnd;
  if (mode_.mode == Mode::kStandby && !inputs.near_route) return FaultCode::kOffRoute;
  return FaultCode::kNone;
}

bool ControlLoop::Emit(const control::LimitedCommand& command, Trigger trigger) {
  const Answer answer{
      .mode = mode_.mode,
      .state_counter = trigger == Trigger::kState ? states_.state().counter : kNoState,
      .plan_age = static_cast<std::uint8_t>(plan_.empty() ? kNoPlanAge : std::min(PlanAge(), kNoPlanAge))};
  frames_.resize(kCommands);
  if (!gate_.Encode(command, answer, std::span<can::Frame, kCommands>(frames_))) {
    frames_.clear();
    return false;
  }
  return true;
}

template <typename Message>
void ControlLoop::EmitReport(const Message& message) {
  frames_.emplace_back();
  if (!gate_.Encode(message, frames_.back())) {
    frames_.pop_back();  // a figure that is no number is not told
  }
}

void ControlLoop::EmitStatus() {
  const int iterations = last_solve_ != nullptr ? last_solve_->iterations : 0;
  EmitReport(
      dbc::ControllerStatus{.mode = mode_.mode,
                            .fault_code = report_.fault,
                            .solver_status = report_.solver,
                            .iterations = static_cast<std::uint8_t>(std::clamp(iterations, 0, 255)),
                            .solve_time = ToSeconds(report_.step_time),
                            .deadline_misses = static_cast<std::uint16_t>(report_.deadline_misses % 1024)});
}

void ControlLoop::EmitReports() {
  EmitStatus();
  const control::Plan* solve = last_solve_;
  EmitReport(dbc::SchedulingHealth{.scheduling_error = solve != nullptr ? solve->scheduling_error : 0.0,
                                   .active_rows = static_cast<std::uint16_t>(
                                       solve != nullptr ? std::clamp(solve->active_trust_rows, 0, 1023) : 0),
                                   .largest_slack = solve != nullptr ? solve->largest_slack : 0.0});
  if (!settings_.send_horizon || new_plan_ == nullptr) {
    return;
  }
  EmitReport(dbc::HorizonHeader{
      .points = static_cast<std::uint8_t>(std::min<std::size_t>(new_plan_->z.size(), kMaxPoints)),
      .state_counter = states_.state().counter,
      .step = ToSeconds(settings_.period)});
  for (std::size_t i = 0; i < std::min(new_plan_->z.size(), kMaxPoints); ++i) {
    const control::State& z = new_plan_->z[i];
    EmitReport(
        dbc::HorizonPoint{.index = static_cast<std::uint8_t>(i), .X = z[control::kX], .Y = z[control::kY]});
  }
}

}  // namespace lpvmpcd
