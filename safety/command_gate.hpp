// The only way onto the bus. The gate builds the daemon's frames: it accepts commands only from the limiter, which has
// checked range, rate and age, enables them only in the modes that command (bus::Commands), and adds the end-to-end
// protection. The Transmitter asks the gate for each frame whether it may be sent.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>

#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"
#include "safety/command_limiter.hpp"

namespace safety {

// The mode, state and plan behind a command.
struct Answer {
  bus::Mode mode = bus::Mode::kInit;
  std::uint8_t state_counter = 15;  // counter of the answered state set; 15: none
  std::uint8_t plan_age = 63;       // cycles; 63: 63 or more, or no plan
};

// Messages that the daemon sends besides its commands. The horizon's header and points share a message.
using SentReports = std::tuple<bus::ControllerStatus, bus::SchedulingHealth, bus::ControllerDiagnostics,
                               bus::ConstraintReport, bus::DisturbanceEstimate, bus::ManoeuvreStatus,
                               bus::HorizonHeader, bus::HorizonPoint>;

template <typename Typed, typename List>
inline constexpr bool kIsOneOf = false;
template <typename Typed, typename... Types>
inline constexpr bool kIsOneOf<Typed, std::tuple<Types...>> = (std::is_same_v<Typed, Types> || ...);

template <typename Typed>
concept Report = kIsOneOf<Typed, SentReports>;

class CommandGate {
 public:
  // `bus` must outlive the gate.
  explicit CommandGate(const bus::VehicleBus& bus);

  // Encodes SteeringCommand and AccelerationCommand, in this order. False if a value could not be encoded: then nothing
  // may be sent.
  [[nodiscard]] bool Encode(const LimitedCommand& command, const Answer& answer,
                            std::span<can::Frame, 2> out);

  // Encodes a report. Each message has its own counter. False as above.
  template <Report Typed>
  [[nodiscard]] bool Encode(const Typed& report, can::Frame& out) {
    return Encode(bus_->Info<Typed>().id, report, out);
  }

  // True for frames that this daemon may send: standard data frames of its own messages with valid length, CRC and
  // counter.
  [[nodiscard]] bool MaySend(const can::Frame& frame) const;

 private:
  static constexpr std::size_t kSent = 2 + std::tuple_size_v<SentReports>;

  [[nodiscard]] bool Encode(std::uint32_t id, const bus::Message& message, can::Frame& out);

  const bus::VehicleBus* bus_;
  // The commands first, then the reports. Types that share a message share its first place.
  std::array<std::uint32_t, kSent> ids_;
  std::array<std::uint8_t, kSent> counters_{};
};

}  // namespace safety
