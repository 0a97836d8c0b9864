// The only way onto the bus. Makes the frames: takes a command only from the limiter, which judged its range, rate and
// age, sets `enable` in the modes that command (mode_machine.hpp) and in no other, protects it end to end. And lets
// them through: the Transmitter asks of every frame whether it may be sent.
#pragma once

#include <array>
#include <cstdint>
#include <span>

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

class CommandGate {
 public:
  // `bus` must outlive the gate.
  explicit CommandGate(const bus::VehicleBus& bus);

  // SteeringCommand and AccelerationCommand, in this order. False: nothing may be sent, a value could not be
  // encoded.
  [[nodiscard]] bool Encode(const LimitedCommand& command, const Answer& answer,
                            std::span<can::Frame, 2> out);

  // Reports; each with a counter of its own.
  [[nodiscard]] bool Encode(const bus::ControllerStatus& status, can::Frame& out);
  [[nodiscard]] bool Encode(const bus::SchedulingHealth& health, can::Frame& out);
  [[nodiscard]] bool Encode(const bus::ControllerDiagnostics& diagnostics, can::Frame& out);
  [[nodiscard]] bool Encode(const bus::ConstraintReport& constraint, can::Frame& out);
  [[nodiscard]] bool Encode(const bus::HorizonHeader& header, can::Frame& out);
  [[nodiscard]] bool Encode(const bus::HorizonPoint& point, can::Frame& out);

  // True for the frames that this daemon may put on the bus: its seven messages, as standard data frames of the right
  // length, with the CRC that the gate gave them.
  [[nodiscard]] bool MaySend(const can::Frame& frame) const;

 private:
  enum Tx : std::size_t {
    kSteering,
    kAcceleration,
    kStatus,
    kHealth,
    kDiagnostics,
    kConstraint,
    kHorizon,
    kTxMessages
  };

  [[nodiscard]] bool Encode(Tx tx, const bus::Message& message, can::Frame& out);

  const bus::VehicleBus* bus_;
  std::array<std::uint32_t, kTxMessages> ids_{};
  std::array<std::uint8_t, kTxMessages> counters_{};
};

}  // namespace safety
