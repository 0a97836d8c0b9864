// The only way onto the bus. The gate makes the daemon's frames: it takes a command from the limiter alone, which judged its
// range, rate and age, enables it in the modes that command (mode_machine.hpp) and in no other, and protects it end to end.
// The Transmitter asks the gate of every frame whether it may be sent.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"
#include "safety/command_limiter.hpp"

namespace safety {

// What a command answers.
struct Answer {
  bus::Mode mode = bus::Mode::kInit;
  std::uint8_t state_counter = 15;  // 15: answers no state set
  std::uint8_t plan_age = 63;       // cycles; 63, which the frame has for anything above: or no plan
};

// What the daemon tells beside its commands. The horizon's header and points share a message.
template <typename Typed>
concept Report =
    std::is_same_v<Typed, bus::ControllerStatus> || std::is_same_v<Typed, bus::SchedulingHealth> ||
    std::is_same_v<Typed, bus::ControllerDiagnostics> || std::is_same_v<Typed, bus::ConstraintReport> ||
    std::is_same_v<Typed, bus::HorizonHeader> || std::is_same_v<Typed, bus::HorizonPoint>;

class CommandGate {
 public:
  // `bus` must outlive the gate.
  explicit CommandGate(const bus::VehicleBus& bus);

  // SteeringCommand and AccelerationCommand, in this order. False: nothing may be sent, a value could not be
  // encoded.
  [[nodiscard]] bool Encode(const LimitedCommand& command, const Answer& answer,
                            std::span<can::Frame, 2> out);

  // A report. Every message has a counter of its own. False: as above.
  template <Report Typed>
  [[nodiscard]] bool Encode(const Typed& report, can::Frame& out) {
    return Encode(bus_->Info<Typed>().id, report, out);
  }

  // True for the frames that this daemon may put on the bus: standard data frames of its own messages, with the right
  // length and CRC.
  [[nodiscard]] bool MaySend(const can::Frame& frame) const;

 private:
  struct Sent {
    std::uint32_t id = 0;
    std::uint8_t counter = 0;
  };

  [[nodiscard]] bool Encode(std::uint32_t id, const bus::Message& message, can::Frame& out);

  const bus::VehicleBus* bus_;
  std::array<Sent, 7> sent_;  // by message, the commands first
};

}  // namespace safety
