#include "loop/control_loop.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace loop {
namespace {

constexpr std::uint8_t kNoState = 15;
constexpr int kNoPlanAge = 63;
constexpr std::size_t kCommands = 2;
constexpr std::size_t kReports =
    std::tuple_size_v<safety::SentReports> - 1;  // reports of a cycle besides the horizon's points

// A command cannot be older than the last input of its plan.
LoopSettings WithinHorizon(LoopSettings settings, int horizon) {
  settings.limits.max_age = std::min(settings.limits.max_age, horizon - 1);
  return settings;
}

PlanRequest RequestOf(const safety::ModeState& mode, const safety::ModeInputs& inputs) {
  if (safety::EngagementRequested(mode, inputs)) return PlanRequest::kFirst;
  if (!bus::Commands(mode.mode)) return PlanRequest::kNone;
  const bool possible = inputs.state_fresh && inputs.route_left > 0;
  return possible ? PlanRequest::kNext : PlanRequest::kNoState;
}

}  // namespace

ControlLoop::ControlLoop(const LoopSettings& settings, const bus::VehicleBus& bus,
                         control::Controller& controller, const control::TimeReference& reference,
                         const control::RoadProfile& profile, std::function<base::Time()> stopwatch,
                         control::PlanCheck* check)
    : settings_(WithinHorizon(settings, controller.horizon())),
      inbox_(bus, settings.monitor, settings.period),
      tracker_({.vehicle = settings.vehicle,
                .t_s = base::ToSeconds(settings.period),
                .max_heading_error = settings.engage_max_heading_error,
                .standstill_speed = settings.standstill_speed},
               reference, profile),
      planner_({.period = settings.period,
                .deadline = settings.deadline,
                .command_delay = settings.command_delay,
                .vehicle = settings.vehicle,
                .offset_free = settings.offset_free,
                .mu = settings.mu,
                .stop_deceleration = settings.stop_deceleration},
               controller, profile, std::move(stopwatch), check),
      commands_(settings_.limits),
      gate_(bus),
      reports_(settings.period) {
  frames_.reserve(kCommands + kReports + static_cast<std::size_t>(controller.horizon()) + 1);
}

void ControlLoop::Reconfigure(const LoopSettings& settings) {
  const safety::CommandLimits limits = settings_.limits;
  settings_ = settings;
  settings_.limits = limits;
  inbox_.Reconfigure(settings.monitor);
  tracker_.Reconfigure(settings.engage_max_heading_error, settings.standstill_speed);
  planner_.Reconfigure(settings.stop_deceleration);
}

bool ControlLoop::Receive(const can::Frame& frame, base::Time now) {
  return inbox_.Receive(frame, now);
}

std::span<const can::Frame> ControlLoop::Cycle(base::Time now, Trigger trigger) {
  planner_.StartStopwatch();
  const safety::ModeState before = mode_;
  const bool commanding = bus::Commands(before.mode);

  // 1. The snapshot of the inputs, and the vehicle's place on the route.
  const Snapshot known = inbox_.TakeSnapshot(now, trigger);
  const control::Input applied = commands_.Applied(known.state, commanding);
  const control::RoutePlace place = tracker_.Advance(known, commanding, applied);
  const control::RouteProgress progress = planner_.ProgressAt(place);

  // 2. The plan: a new one from a new state; without one, or if it is late or refused, the active plan continues.
  safety::ModeInputs inputs = InputsOf(known, place, progress);
  const PlanRequest request = RequestOf(before, inputs);
  const Outcome outcome = planner_.Plan(request, known, place, commanding, applied);
  AddPlan(outcome, inputs);

  // 3. The mode.
  mode_ = safety::Next(before, inputs, settings_.modes);

  // 4. The command, through limiter and gate. If one of them refuses it, the mode becomes Fault.
  const safety::LimitResult limited = Issue(known, place, outcome, applied, inputs);
  if (bus::Commands(mode_.mode)) {
    commands_.Apply(*limited.command);
  } else {
    planner_.Forget();
  }

  // 5. The reports. They follow the commands, so that these are sent first.
  const CycleResult result{known, place, progress, inputs, outcome, limited, mode_, before};
  reports_.Write(result, planner_);
  reports_.AppendFrames(result, settings_.send_horizon, gate_, frames_);
  return frames_;
}

std::span<const can::Frame> ControlLoop::Disable() {
  if (bus::Commands(mode_.mode)) {
    mode_ = {.mode = bus::Mode::kStandby, .cause = safety::Cause::kReleased};
  }
  planner_.Forget();
  static_cast<void>(Encode(commands_.Measured(inbox_.state()), {}, {}));
  return frames_;
}

std::span<const can::Frame> ControlLoop::Announce() {
  frames_.clear();
  reports_.AppendStatus(gate_, frames_);
  return frames_;
}

safety::ModeInputs ControlLoop::InputsOf(const Snapshot& known, const control::RoutePlace& place,
                                         const control::RouteProgress& progress) const {
  const double speed = known.state.z[control::kUpsilon];
  return {.bus_up = known.bus_up,
          .state_new = known.state_new,
          .state_fresh = known.state_fresh,
          .state_rejected = known.state_rejected,
          .obstacles_fresh = known.obstacles_fresh,
          .request_fresh = known.request_fresh,
          .engage = known.engage,
          .released = known.released,
          .override_seen = known.override_seen,
          .near_route = place.on_route && speed >= settings_.engage_min_speed,
          .route_left = place.on_route ? progress.steps_left : 0,
          .standstill = known.state_fresh && speed < settings_.standstill_speed,
          .silent = known.silent};
}

void ControlLoop::AddPlan(const Outcome& outcome, safety::ModeInputs& inputs) const {
  inputs.plan_fault = outcome.fault;
  inputs.plan_new = outcome.accepted;
  inputs.stop_due = outcome.stop_due;
  inputs.plan_usable = planner_.active().Covers(outcome.step);
  inputs.plan_left = planner_.active().Left(outcome.step);
}

// Encodes the command of the mode. If limiter or encoder refuse it, the mode becomes Fault and the measured inputs are
// encoded, disabled.
safety::LimitResult ControlLoop::Issue(const Snapshot& known, const control::RoutePlace& place,
                                       const Outcome& outcome, const control::Input& applied,
                                       safety::ModeInputs& inputs) {
  const control::Input stop = mode_.mode == bus::Mode::kSafeStop
                                  ? planner_.StopInput(known, place, tracker_.motion(), applied)
                                  : applied;
  safety::LimitResult limited =
      commands_.Command(mode_.mode, outcome.step, planner_.active(), stop, known.state, applied);
  if (!limited.command || !Encode(limited, known, outcome)) {
    inputs.internal_error = true;
    mode_ = safety::Next(mode_, inputs, settings_.modes);
    limited = commands_.Measured(known.state);
    static_cast<void>(Encode(limited, known, outcome));
  }
  return limited;
}

bool ControlLoop::Encode(const safety::LimitResult& limited, const Snapshot& known, const Outcome& outcome) {
  const ActivePlan& plan = planner_.active();
  const int age = plan.exists() ? plan.Age(outcome.step) : kNoPlanAge;
  const bool answers = known.state_new && !outcome.late;
  const safety::Answer answer{.mode = mode_.mode,
                              .state_counter = answers ? known.state.counter : kNoState,
                              .plan_age = static_cast<std::uint8_t>(std::min(age, kNoPlanAge))};
  frames_.resize(kCommands);
  if (!gate_.Encode(*limited.command, answer, std::span<can::Frame, kCommands>(frames_))) {
    frames_.clear();
    return false;
  }
  return true;
}

}  // namespace loop
