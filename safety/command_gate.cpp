#include "safety/command_gate.hpp"

#include <algorithm>

#include "dbc/e2e.hpp"
#include "safety/mode_machine.hpp"

namespace safety {
namespace {

template <typename... Types>
std::array<std::uint32_t, 2 + sizeof...(Types)> IdsOf(const bus::VehicleBus& bus,
                                                      std::type_identity<std::tuple<Types...>> /*reports*/) {
  return {bus.Info<bus::SteeringCommand>().id, bus.Info<bus::AccelerationCommand>().id,
          bus.Info<Types>().id...};
}

}  // namespace

CommandGate::CommandGate(const bus::VehicleBus& bus)
    : bus_(&bus), ids_(IdsOf(bus, std::type_identity<SentReports>())) {}

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
    if (!Encode(ids_[i], pair[i], out[i])) return false;
  }
  return true;
}

bool CommandGate::MaySend(const can::Frame& frame) const {
  return frame.kind == can::FrameKind::kData && !frame.extended && !frame.fd &&
         std::ranges::find(ids_, frame.id) != ids_.end() &&
         bus_->Check(frame.id, frame.Payload()).verdict == bus::E2eVerdict::kOk;
}

bool CommandGate::Encode(std::uint32_t id, const bus::Message& message, can::Frame& out) {
  std::uint8_t& counter = counters_[static_cast<std::size_t>(std::ranges::find(ids_, id) - ids_.begin())];
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
