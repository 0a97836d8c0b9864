#include "loop/reports.hpp"

#include <algorithm>

#include "loop/plan_verdict.hpp"
#include "loop/report_frames.hpp"

namespace loop {
namespace {

bus::FaultCode FaultCodeOf(const CycleResult& result, bus::FaultCode last_refusal) {
  const bus::Mode mode = result.mode.mode;
  const bool stopped = mode == bus::Mode::kSafeStop || mode == bus::Mode::kFault;
  const auto cause = stopped ? result.mode.cause : safety::PresentFault(result.inputs);
  if (cause) return *cause == safety::Cause::kSolverFailed ? last_refusal : safety::FaultOf(*cause);
  if (mode != bus::Mode::kStandby) return bus::FaultCode::kNone;
  if (result.mode.cause == safety::Cause::kRouteEnd) return bus::FaultCode::kRouteEnd;
  if (!result.inputs.near_route) return bus::FaultCode::kOffRoute;
  return result.inputs.route_left <= 0 ? bus::FaultCode::kRouteEnd : bus::FaultCode::kNone;
}

// True if the driver asked for engagement in this cycle and the mode is still Standby.
bool EngagementRefused(const CycleResult& result) {
  const bool asked = result.before.mode == bus::Mode::kStandby && result.known.state_new &&
                     safety::RisingEdge(result.before, result.inputs);
  return asked && result.mode.mode == bus::Mode::kStandby;
}

}  // namespace

void Reports::Write(const CycleResult& result, const Planner& planner) {
  const Outcome& outcome = result.outcome;
  const control::Plan* solution = outcome.solution;
  const bool commanding = bus::Commands(result.mode.mode);
  const ActivePlan& plan = planner.active();
  report_ = {.mode = result.mode.mode,
             .previous_mode = result.before.mode,
             .cause = result.mode.cause,
             .fault = FaultCodeOf(result, planner.last_refusal()),
             .solver = solution != nullptr ? OnBus(solution->status).status : bus::SolverStatus::kNone,
             .iterations = solution != nullptr ? solution->iterations : 0,
             .plan_accepted = outcome.accepted,
             .relaxation = outcome.relaxation,
             .rejection = outcome.rejection,
             .disturbance = planner.disturbance(),
             .manoeuvre = OnBus(solution != nullptr ? solution->manoeuvre : std::nullopt),
             .mu = planner.mu(),
             .engagement_refused = EngagementRefused(result),
             .faulty_message = result.known.faulty_message,
             .countdown = Countdown(result),
             .plan_age = commanding && plan.exists() ? plan.Age(outcome.step) : -1,
             .route_index = result.place.on_route ? static_cast<int>(result.progress.sample) : -1,
             .limited = result.limited.status == safety::LimitStatus::kLimited,
             .command = result.limited.command->u(),
             .step_time = outcome.solve_time,
             .cycle_latency = cycle_latency_,
             .cycles = ++cycles_,
             .deadline_misses = deadline_misses_ += outcome.late ? 1 : 0,
             .plans_refused = planner.refused(),
             .last_refusal = planner.last_refusal()};
}

base::Time Reports::Countdown(const CycleResult& result) const {
  const bus::Mode mode = result.mode.mode;
  if (mode == bus::Mode::kSafeStop) return base::Time{0};
  if (!bus::Drives(mode)) return base::Time::max();
  std::int64_t cycles = result.inputs.route_left;
  if (mode == bus::Mode::kDegraded) {
    cycles = std::min<std::int64_t>(cycles, result.mode.degraded_left);
    if (result.inputs.plan_fault) cycles = std::min<std::int64_t>(cycles, result.inputs.plan_left);
  }
  return cycles * period_;
}

void Reports::AppendStatus(safety::CommandGate& gate, std::vector<can::Frame>& frames) const {
  loop::AppendStatus(report_, gate, frames);
}

void Reports::AppendFrames(const CycleResult& result, bool send_horizon, safety::CommandGate& gate,
                           std::vector<can::Frame>& frames) const {
  AppendStatus(gate, frames);
  AppendHealth(result.outcome.solution, gate, frames);
  AppendDiagnostics(report_, result.mode, gate, frames);
  AppendConstraint(report_, gate, frames);
  AppendDisturbance(report_, gate, frames);
  AppendManoeuvre(report_, gate, frames);
  if (send_horizon && result.outcome.accepted) {
    AppendHorizon(*result.outcome.solution, result.known.state.counter, period_, gate, frames);
  }
}

}  // namespace loop
