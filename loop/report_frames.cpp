#include "loop/report_frames.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace loop {
namespace {

constexpr std::size_t kMaxPoints = 127;

// Code on the bus: 0 for none, otherwise the enumerator plus 1.
template <typename Enum>
std::uint8_t CodeOf(const std::optional<Enum>& value) {
  return value ? static_cast<std::uint8_t>(static_cast<unsigned>(*value) + 1U) : std::uint8_t{0};
}

bus::ConstraintName NameOf(control::ConstraintKind kind) {
  switch (kind) {
    case control::ConstraintKind::kModel:
      return bus::ConstraintName::kModel;
    case control::ConstraintKind::kInput:
      return bus::ConstraintName::kInput;
    case control::ConstraintKind::kRate:
      return bus::ConstraintName::kRate;
    case control::ConstraintKind::kState:
      return bus::ConstraintName::kState;
    case control::ConstraintKind::kRoad:
      return bus::ConstraintName::kRoad;
    case control::ConstraintKind::kObstacle:
      return bus::ConstraintName::kObstacle;
    case control::ConstraintKind::kFriction:
      return bus::ConstraintName::kFriction;
    case control::ConstraintKind::kTrust:
      break;
  }
  return bus::ConstraintName::kTrust;
}

template <typename Message>
void Append(const Message& message, safety::CommandGate& gate, std::vector<can::Frame>& frames) {
  frames.emplace_back();
  if (!gate.Encode(message, frames.back())) {
    frames.pop_back();
  }
}

}  // namespace

void AppendStatus(const CycleReport& report, safety::CommandGate& gate, std::vector<can::Frame>& frames) {
  Append(bus::ControllerStatus{.mode = report.mode,
                               .fault_code = report.fault,
                               .solver_status = report.solver,
                               .iterations = static_cast<std::uint8_t>(std::clamp(report.iterations, 0, 255)),
                               .solve_time = base::ToSeconds(report.step_time),
                               .deadline_misses = static_cast<std::uint16_t>(report.deadline_misses % 1024)},
         gate, frames);
}

void AppendHealth(const control::Plan* solve, safety::CommandGate& gate, std::vector<can::Frame>& frames) {
  bus::SchedulingHealth health;
  if (solve != nullptr) {
    health = {.scheduling_error = solve->scheduling_error,
              .active_rows = static_cast<std::uint16_t>(std::clamp(solve->active_trust_rows, 0, 1023)),
              .largest_slack = solve->largest_slack};
  }
  Append(health, gate, frames);
}

void AppendDiagnostics(const CycleReport& report, const safety::ModeState& mode, safety::CommandGate& gate,
                       std::vector<can::Frame>& frames) {
  const auto& faulty = report.faulty_message;
  Append(bus::ControllerDiagnostics{.cause = mode.cause,
                                    .previous_mode = mode.previous,
                                    .countdown = base::ToSeconds(report.countdown),
                                    .faulty_message =
                                        CodeOf(faulty ? std::optional(faulty->message) : std::nullopt),
                                    .frame_fault = CodeOf(faulty ? faulty->reason : std::nullopt),
                                    .cycle_latency = base::ToSeconds(report.cycle_latency),
                                    .plans_refused = static_cast<std::uint16_t>(report.plans_refused % 1024)},
         gate, frames);
}

void AppendConstraint(const CycleReport& report, safety::CommandGate& gate, std::vector<can::Frame>& frames) {
  // A plan that is followed as the lesser evil is reported as relaxed.
  const bool rejected = report.rejection && !report.plan_accepted;
  const auto& violation = report.unmet();
  bus::ConstraintReport unmet;
  if (violation) {
    const auto code = [](int value, int most) {
      return static_cast<std::uint8_t>(std::clamp(value, 0, most));
    };
    const bool relaxed = report.solver == bus::SolverStatus::kSolved;
    unmet = {.verdict = rejected  ? bus::ConstraintVerdict::kRejected
                        : relaxed ? bus::ConstraintVerdict::kRelaxed
                                  : bus::ConstraintVerdict::kUnsolved,
             .constraint = NameOf(violation->constraint.kind),
             .index = code(violation->constraint.index, 63),
             .step = code(violation->constraint.step, 127),
             .amount = violation->amount};
  }
  Append(unmet, gate, frames);
}

void AppendDisturbance(const CycleReport& report, safety::CommandGate& gate,
                       std::vector<can::Frame>& frames) {
  const control::Disturbance& disturbance = report.disturbance;
  Append(bus::DisturbanceEstimate{.steering_offset = disturbance.delta_0,
                                  .lateral_acceleration = disturbance.a_y,
                                  .longitudinal_acceleration = disturbance.a_x,
                                  .stiffness_factor = disturbance.stiffness_factor,
                                  .grip = report.mu},
         gate, frames);
}

bus::ManoeuvreStatus OnBus(const std::optional<control::ManoeuvreStatus>& manoeuvre) {
  using control::Decision, control::Reason, control::Side;
  if (!manoeuvre) return {};
  const auto& decided = *manoeuvre;
  // The bus has the same enumerators after its own "none".
  static_assert(static_cast<int>(bus::ManoeuvreDecision::kSqueeze) ==
                static_cast<int>(Decision::kSqueeze) + 1);
  static_assert(static_cast<int>(bus::ManoeuvreReason::kNoWay) == static_cast<int>(Reason::kNoWay) + 1);
  bus::ManoeuvreStatus status{
      .decision = static_cast<bus::ManoeuvreDecision>(static_cast<int>(decided.decision) + 1),
      .reason = static_cast<bus::ManoeuvreReason>(static_cast<int>(decided.reason) + 1),
      .side = decided.side == Side::kLeft    ? bus::PassingSide::kLeft
              : decided.side == Side::kRight ? bus::PassingSide::kRight
                                             : bus::PassingSide::kUnknown,
      .left_out = static_cast<std::uint8_t>(std::min<std::size_t>(decided.left_out, 63))};
  if (decided.object >= 0) status.object_id = static_cast<std::uint8_t>(decided.object);
  status.stop_distance = std::min(decided.stop_distance, status.stop_distance);
  status.speed_limit = std::min(decided.speed_limit, status.speed_limit);
  return status;
}

void AppendManoeuvre(const CycleReport& report, safety::CommandGate& gate, std::vector<can::Frame>& frames) {
  Append(report.manoeuvre, gate, frames);
}

void AppendHorizon(const control::Plan& plan, std::uint8_t state_counter, base::Time period,
                   safety::CommandGate& gate, std::vector<can::Frame>& frames) {
  const std::size_t points = std::min(plan.z.size(), kMaxPoints);
  Append(bus::HorizonHeader{.points = static_cast<std::uint8_t>(points),
                            .state_counter = state_counter,
                            .step = base::ToSeconds(period)},
         gate, frames);
  for (std::size_t i = 0; i < points; ++i) {
    const control::State& z = plan.z[i];
    Append(bus::HorizonPoint{.index = static_cast<std::uint8_t>(i), .X = z[control::kX], .Y = z[control::kY]},
           gate, frames);
  }
}

}  // namespace loop
