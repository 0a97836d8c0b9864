// The report frames of a cycle, appended to `frames`. A frame with a non-finite value is omitted.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "bus/messages.hpp"
#include "can/frame.hpp"
#include "control/mpc/controller.hpp"
#include "loop/cycle_report.hpp"
#include "safety/command_gate.hpp"

namespace loop {

// ControllerStatus.
void AppendStatus(const CycleReport& report, safety::CommandGate& gate, std::vector<can::Frame>& frames);

// SchedulingHealth of a control step; all values are 0 without one (null).
void AppendHealth(const control::Plan* solve, safety::CommandGate& gate, std::vector<can::Frame>& frames);

// ControllerDiagnostics.
void AppendDiagnostics(const CycleReport& report, const safety::ModeState& mode, safety::CommandGate& gate,
                       std::vector<can::Frame>& frames);

// ConstraintReport: the violation found by the check, otherwise the constraint that the plan could not meet.
void AppendConstraint(const CycleReport& report, safety::CommandGate& gate, std::vector<can::Frame>& frames);

// DisturbanceEstimate.
void AppendDisturbance(const CycleReport& report, safety::CommandGate& gate, std::vector<can::Frame>& frames);

// ManoeuvreStatus.
void AppendManoeuvre(const CycleReport& report, safety::CommandGate& gate, std::vector<can::Frame>& frames);
// A decision as it is told on the bus.
[[nodiscard]] bus::ManoeuvreStatus OnBus(const std::optional<control::ManoeuvreStatus>& manoeuvre);

// PlannedHorizon: header and points of a plan made for the state with this counter. At most 127 points, the largest
// number that the message can carry.
void AppendHorizon(const control::Plan& plan, std::uint8_t state_counter, base::Time period,
                   safety::CommandGate& gate, std::vector<can::Frame>& frames);

}  // namespace loop
