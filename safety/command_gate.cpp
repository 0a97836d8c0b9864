#include "safety/command_gate.hpp"

#include <algorithm>
#include <string>

#include "dbc/e2e.hpp"
#include "safety/mode_machine.hpp"

namespace safety {

CommandGate::CommandGate(const bus::VehicleBus& bus) : bus_(&bus) {
  constexpr std::array kNames = {"SteeringCommand",  "AccelerationCommand",   "ControllerStatus",
                                 "SchedulingHealth", "ControllerDiagnostics", "ConstraintReport",
                                 "PlannedHorizon"};
  static_assert(kNames.size() == kTxMessages);
  for (std::size_t i = 0; i < kTxMessages; ++i) {
    ids_[i] = bus.Find(std::string(kNames[i]))->id;  // every bus has our messages
  }
}

bool CommandGate::Encode(const LimitedCommand& command, const Answer& answer, std::span<can::Frame, 2> out) {
  const bool enable = bus::Commands(answer.mode);
  const bus::SteeringCommand steering{.enable = enable,
                                      .mode = answer.mode,
                                      .state_counter = answer.state_counter,
                                      .plan_age = answer.plan_age,
                                      .delta = command.steering()};
  const bus::AccelerationCommand acceleration{.enable = enable,
                                              .mode = answer.mode,
                                              .state_counter = answer.state_counter,
                                              .plan_age = answer.plan_age,
                                              .acceleration = command.acceleration()};
  const auto pair = std::to_array<bus::Message>({steering, acceleration});
  for (const Tx tx : {kSteering, kAcceleration}) {
    if (!Encode(tx, pair[tx], out[tx])) return false;
  }
  return true;
}

bool CommandGate::Encode(const bus::ControllerStatus& status, can::Frame& out) {
  return Encode(kStatus, status, out);
}

bool CommandGate::Encode(const bus::SchedulingHealth& health, can::Frame& out) {
  return Encode(kHealth, health, out);
}

bool CommandGate::Encode(const bus::ControllerDiagnostics& diagnostics, can::Frame& out) {
  return Encode(kDiagnostics, diagnostics, out);
}

bool CommandGate::Encode(const bus::ConstraintReport& constraint, can::Frame& out) {
  return Encode(kConstraint, constraint, out);
}

bool CommandGate::Encode(const bus::HorizonHeader& header, can::Frame& out) {
  return Encode(kHorizon, header, out);
}

bool CommandGate::Encode(const bus::HorizonPoint& point, can::Frame& out) {
  return Encode(kHorizon, point, out);
}

bool CommandGate::MaySend(const can::Frame& frame) const {
  return frame.kind == can::FrameKind::kData && !frame.extended && !frame.fd &&
         std::ranges::find(ids_, frame.id) != ids_.end() &&
         bus_->Check(frame.id, frame.Payload()).verdict == bus::E2eVerdict::kOk;
}

bool CommandGate::Encode(Tx tx, const bus::Message& message, can::Frame& out) {
  bus::RawMessage raw;
  if (bus_->Encode(message, counters_[tx], raw) == dbc::EncodeStatus::kNotFinite) {
    return false;
  }
  counters_[tx] = dbc::NextCounter(counters_[tx]);
  out = can::Frame{.id = raw.id, .length = raw.length};
  std::ranges::copy(raw.Payload(), out.data.begin());
  return true;
}

}  // namespace safety
