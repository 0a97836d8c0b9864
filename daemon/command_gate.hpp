// The only way onto the bus. Makes the frames: takes a command only from the limiter, which judged its range, rate and
// age, sets `enable` in the modes that command (mode_machine.hpp) and in no other, protects it end to end. And lets
// them through: the Transmitter asks of every frame whether it may be sent.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "can/frame.hpp"
#include "control/command_limiter.hpp"
#include "dbc/vehicle_bus.hpp"

namespace lpvmpcd {

// What a command answers.
struct Answer {
  dbc::Mode mode = dbc::Mode::kInit;
  std::uint8_t state_counter = 15;  // 15: answers no state set
  std::uint8_t plan_age = 63;       // cycles; 63, which the frame has for anything above: or no plan
};

class CommandGate {
 public:
  // `bus` must outlive the gate.
  explicit CommandGate(const dbc::VehicleBus& bus);

  // SteeringCommand and AccelerationCommand, in this order. False: nothing may be sent, a value could not be
  // encoded.
  [[nodiscard]] bool Encode(const control::LimitedCommand& command, const Answer& answer,
                            std::span<can::Frame, 2> out);

  // Reports; each with a counter of its own.
  [[nodiscard]] bool Encode(const dbc::ControllerStatus& status, can::Frame& out);
  [[nodiscard]] bool Encode(const dbc::SchedulingHealth& health, can::Frame& out);
  [[nodiscard]] bool Encode(const dbc::ControllerDiagnostics& diagnostics, can::Frame& out);
  [[nodiscard]] bool Encode(const dbc::ConstraintReport& constraint, can::Frame& out);
  [[nodiscard]] bool Encode(const dbc::HorizonHeader& header, can::Frame& out);
  [[nodiscard]] bool Encode(const dbc::HorizonPoint& point, can::Frame& out);

  // True for the frames that this daemon may put on the bus: its six messages, as standard data frames of the right
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

  [[nodiscard]] bool Encode(Tx tx, const dbc::Message& message, can::Frame& out);

  const dbc::VehicleBus* bus_;
  std::array<std::uint32_t, kTxMessages> ids_{};
  std::array<std::uint8_t, kTxMessages> counters_{};
};

}  // namespace lpvmpcd
