// The typed messages bound to a DBC: converts physical values to payload bytes and back, with end-to-end protection.
//
// Example:
//   VehicleBus bus;                                        // the built-in dbc/vehicle.dbc
//   RawMessage raw;
//   if (bus.Encode(VehiclePose{.X = 12.0, .Y = -3.5}, counter, raw) != dbc::EncodeStatus::kOk) ...
//   ... bus.Check(raw.id, raw.Payload()) ... bus.Decode(raw.id, raw.Payload()) ...
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bus/messages.hpp"
#include "dbc/codec.hpp"
#include "dbc/database.hpp"

namespace bus {

// The signals of the end-to-end protection, which every message has.
inline constexpr std::string_view kCrcSignal = "CRC";
inline constexpr std::string_view kCounterSignal = "Counter";

struct RawMessage {
  std::uint32_t id = 0;
  std::uint8_t length = 0;
  std::array<std::byte, 8> data{};

  [[nodiscard]] std::span<const std::byte> Payload() const { return {data.data(), length}; }
};

// A message on the wire.
struct MessageInfo {
  std::uint32_t id = 0;
  std::string name;
  std::uint8_t length = 0;
  double period = 0.0;        // [s], attribute GenMsgCycleTime; 0 = not periodic
  std::uint16_t data_id = 0;  // attribute E2EDataId
};

enum class E2eVerdict : std::uint8_t { kOk, kWrongLength, kWrongCrc, kInvalidCounter, kUnknownMessage };

struct E2eCheck {
  E2eVerdict verdict = E2eVerdict::kUnknownMessage;
  std::uint8_t counter = 0;  // as received; valid unless the length is wrong or the message is unknown
};

// All ids here are standard ids. Extended frames must not be passed to Check or Decode: they could have the same
// number.
class VehicleBus {
 public:
  VehicleBus();  // the built-in vehicle.dbc
  // `database` is any DBC with the same names. Throws std::runtime_error naming the message, signal or attribute that
  // is missing or unsuitable (an extended id, more than 8 bytes, a CRC that is not byte 0, overlapping signals in one
  // frame).
  explicit VehicleBus(dbc::Database database);
  ~VehicleBus();
  VehicleBus(VehicleBus&&) noexcept;
  VehicleBus& operator=(VehicleBus&&) noexcept;

  // Saturates to the signals' ranges (kSaturated, `out` is written); refuses a NaN or infinite value (kNotFinite, `out`
  // is unchanged). The lower four bits of `counter` are sent, even 15, which no receiver accepts. Does not allocate.
  [[nodiscard]] dbc::EncodeStatus Encode(const Message& message, std::uint8_t counter, RawMessage& out) const;

  // Checks length, CRC and range of the counter. Whether the counter follows its predecessor is for the receiver to
  // check.
  [[nodiscard]] E2eCheck Check(std::uint32_t id, std::span<const std::byte> payload) const;

  // False if a value that Decode would return is outside its range in the DBC or not finite.
  [[nodiscard]] bool InRange(std::uint32_t id, std::span<const std::byte> payload) const;

  // nullopt if the id is not one of ours, the payload is too short, the multiplexor's value is unknown, or a member
  // cannot hold its value (an enumeration without it, a number that is not finite).
  [[nodiscard]] std::optional<Message> Decode(std::uint32_t id, std::span<const std::byte> payload) const;

  [[nodiscard]] const std::vector<MessageInfo>& messages() const;
  [[nodiscard]] const MessageInfo* Find(std::uint32_t id) const;
  // The DBC message that carries a typed message: Info<VehiclePose>().
  template <typename Typed>
  [[nodiscard]] const MessageInfo& Info() const {
    return InfoOf(Message(Typed{}).index());
  }
  [[nodiscard]] const dbc::Database& database() const;

 private:
  [[nodiscard]] const MessageInfo& InfoOf(std::size_t type) const;

  struct Binding;
  std::unique_ptr<Binding> binding_;
};

// The text of the built-in dbc/vehicle.dbc.
[[nodiscard]] std::string_view BuiltInDbc();

}  // namespace bus
