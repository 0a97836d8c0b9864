#include "safety/command_gate.hpp"

#include <algorithm>

#include "dbc/e2e.hpp"
#include "safety/mode_machine.hpp"

namespace safety {

CommandGate::CommandGate(const bus::VehicleBus& bus)
    : bus_(&bus),
      sent_{{{.id = bus.Info<bus::SteeringCommand>().id},
             {.id = bus.Info<bus::AccelerationCommand>().id},
             {.id = bus.Info<bus::ControllerStatus>().id},
             {.id = bus.Info<bus::SchedulingHealth>().id},
             {.id = bus.Info<bus::ControllerDiagnostics>().id},
             {.id = bus.Info<bus::ConstraintReport>().id},
             {.id = bus.Info<bus::HorizonHeader>().id}}} {}

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
  for (std::size_t i = 0; i < pair.size(); ++i) {
    if (!Encode(sent_[i].id, pair[i], out[i])) return false;
  }
  return true;
}

bool CommandGate::MaySend(const can::Frame& frame) const {
  return frame.kind == can::FrameKind::kData && !frame.extended && !frame.fd &&
         std::ranges::find(sent_, frame.id, &Sent::id) != sent_.end() &&
         bus_->Check(frame.id, frame.Payload()).verdict == bus::E2eVerdict::kOk;
}

bool CommandGate::Encode(std::uint32_t id, const bus::Message& message, can::Frame& out) {
  std::uint8_t& counter = std::ranges::find(sent_, id, &Sent::id)->counter;
  bus::RawMessage raw;
  if (bus_->Encode(message, counter, raw) == dbc::EncodeStatus::kNotFinite) {
    return false;
  }
  counter = dbc::NextCounter(counter);
  out = can::Frame{.id = raw.id, .length = raw.length};
  std::ranges::copy(raw.Payload(), out.data.begin());
  return true;
}

}  // namespace safety
