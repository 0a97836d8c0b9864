#include "daemon/report_frames.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace lpvmpcd {
namespace {

constexpr std::size_t kMaxPoints = 127;

// Codes of the bus: 0 is none.
template <typename Enum>
std::uint8_t CodeOf(const std::optional<Enum>& value) {
  return value ? static_cast<std::uint8_t>(static_cast<unsigned>(*value) + 1U) : std::uint8_t{0};
}

dbc::ConstraintName NameOf(control::ConstraintKind kind) {
  switch (kind) {
    case control::ConstraintKind::kModel:
      return dbc::ConstraintName::kModel;
    case control::ConstraintKind::kInput:
      return dbc::ConstraintName::kInput;
    case control::ConstraintKind::kRate:
      return dbc::ConstraintName::kRate;
    case control::ConstraintKind::kState:
      return dbc::ConstraintName::kState;
    case control::ConstraintKind::kRoad:
      return dbc::ConstraintName::kRoad;
    case control::ConstraintKind::kObstacle:
      return dbc::ConstraintName::kObstacle;
    case control::ConstraintKind::kFriction:
      return dbc::ConstraintName::kFriction;
    case control::ConstraintKind::kTrust:
      break;
  }
  return dbc::ConstraintName::kTrust;
}

template <typename Message>
void Append(const Message& message, CommandGate& gate, std::vector<can::Frame>& frames) {
  frames.emplace_back();
  if (!gate.Encode(message, frames.back())) {
    frames.pop_back();
  }
}

}  // namespace

void AppendStatus(const CycleReport& report, CommandGate& gate, std::vector<can::Frame>& frames) {
  Append(dbc::ControllerStatus{.mode = report.mode,
                               .fault_code = report.fault,
                               .solver_status = report.solver,
                               .iterations = static_cast<std::uint8_t>(std::clamp(report.iterations, 0, 255)),
                               .solve_time = ToSeconds(report.step_time),
                               .deadline_misses = static_cast<std::uint16_t>(report.deadline_misses % 1024)},
         gate, frames);
}

void AppendHealth(const control::Plan* solve, CommandGate& gate, std::vector<can::Frame>& frames) {
  dbc::SchedulingHealth health;
  if (solve != nullptr) {
    health = {.scheduling_error = solve->scheduling_error,
              .active_rows = static_cast<std::uint16_t>(std::clamp(solve->active_trust_rows, 0, 1023)),
              .largest_slack = solve->largest_slack};
  }
  Append(health, gate, frames);
}

void AppendDiagnostics(const CycleReport& report, const ModeState& mode, CommandGate& gate,
                       std::vector<can::Frame>& frames) {
  const auto& faulty = report.faulty_message;
  Append(dbc::ControllerDiagnostics{.cause = mode.cause,
                                    .previous_mode = mode.previous,
                                    .countdown = ToSeconds(report.countdown),
                                    .faulty_message =
                                        CodeOf(faulty ? std::optional(faulty->message) : std::nullopt),
                                    .frame_fault = CodeOf(faulty ? faulty->reason : std::nullopt),
                                    .cycle_latency = ToSeconds(report.cycle_latency),
                                    .plans_refused = static_cast<std::uint16_t>(report.plans_refused % 1024)},
         gate, frames);
}

void AppendConstraint(const CycleReport& report, CommandGate& gate, std::vector<can::Frame>& frames) {
  // A plan that is followed all the same, as the lesser evil, gives way.
  const bool rejected = report.rejection && !report.plan_accepted;
  const auto& violation = report.unmet();
  dbc::ConstraintReport told;
  if (violation) {
    const auto code = [](int value, int most) {
      return static_cast<std::uint8_t>(std::clamp(value, 0, most));
    };
    const bool relaxed = report.solver == dbc::SolverStatus::kSolved;
    told = {.verdict = rejected  ? dbc::ConstraintVerdict::kRejected
                       : relaxed ? dbc::ConstraintVerdict::kRelaxed
                                 : dbc::ConstraintVerdict::kUnsolved,
            .constraint = NameOf(violation->constraint.kind),
            .index = code(violation->constraint.index, 15),
            .step = code(violation->constraint.step, 127),
            .amount = violation->amount};
  }
  Append(told, gate, frames);
}

void AppendHorizon(const control::Plan& plan, std::uint8_t state_counter, Time period, CommandGate& gate,
                   std::vector<can::Frame>& frames) {
  const std::size_t points = std::min(plan.z.size(), kMaxPoints);
  Append(dbc::HorizonHeader{.points = static_cast<std::uint8_t>(points),
                            .state_counter = state_counter,
                            .step = ToSeconds(period)},
         gate, frames);
  for (std::size_t i = 0; i < points; ++i) {
    const control::State& z = plan.z[i];
    Append(dbc::HorizonPoint{.index = static_cast<std::uint8_t>(i), .X = z[control::kX], .Y = z[control::kY]},
           gate, frames);
  }
}

}  // namespace lpvmpcd
