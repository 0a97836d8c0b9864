// The frames that tell about a cycle, appended to `frames`, each if its figures are numbers.
#pragma once

#include <cstdint>
#include <vector>

#include "base/time.hpp"
#include "can/frame.hpp"
#include "control/mpc/controller.hpp"
#include "loop/cycle_report.hpp"
#include "safety/command_gate.hpp"

namespace loop {

// ControllerStatus.
void AppendStatus(const CycleReport& report, safety::CommandGate& gate, std::vector<can::Frame>& frames);

// SchedulingHealth of a control step; without one (null) its figures are 0.
void AppendHealth(const control::Plan* solve, safety::CommandGate& gate, std::vector<can::Frame>& frames);

// ControllerDiagnostics.
void AppendDiagnostics(const CycleReport& report, const safety::ModeState& mode, safety::CommandGate& gate,
                       std::vector<can::Frame>& frames);

// ConstraintReport: of a rejected plan what would go wrong with it, else what could not be met.
void AppendConstraint(const CycleReport& report, safety::CommandGate& gate, std::vector<can::Frame>& frames);

// PlannedHorizon, header and points (at most 127, as many as the bus counts), of a plan made for the state of this
// counter.
void AppendHorizon(const control::Plan& plan, std::uint8_t state_counter, base::Time period,
                   safety::CommandGate& gate, std::vector<can::Frame>& frames);

}  // namespace loop
