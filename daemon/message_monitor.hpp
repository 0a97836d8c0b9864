// Judges every received frame before any of its values is used: identity, kind, length, CRC, counter, value
// tables. A frame that fails changes no value and does not make its message look fresh.
//
// Counters go up by one, modulo 15, from frame to frame of a message. Up to `max_lost` frames may be missing
// between two accepted ones (AUTOSAR E2E profile 1: MaxDeltaCounter). After a larger jump the message is
// believed again from the second frame on that follows in sequence. The first frame of a message is accepted
// with any counter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "can/frame.hpp"
#include "daemon/time.hpp"
#include "dbc/vehicle_bus.hpp"

namespace lpvmpcd {

// The messages that the daemon receives.
enum class RxMessage : std::uint8_t {
  kPose,
  kMotion,
  kFeedback,
  kObstacleObject,
  kObstacleList,
  kDriverRequest
};
inline constexpr std::size_t kRxMessages = 6;

enum class RxFault : std::uint8_t {
  kUnknown,         // no message of ours has this id
  kWrongKind,       // an id of ours, but extended, remote, FD; or an error frame
  kWrongLength,     // not the length that the DBC tells
  kWrongCrc,        // payload, or data id of another message
  kInvalidCounter,  // 15
  kRepeated,        // same counter as the frame before
  kCounterJump,     // more frames lost than allowed, or not yet in sequence again
  kInvalidValue,    // a multiplexor or an enumeration without such a value
};
inline constexpr std::size_t kRxFaults = 8;
[[nodiscard]] std::string_view Name(RxFault fault);

struct Accepted {
  RxMessage kind{};
  dbc::Message message{};
  std::uint8_t counter = 0;
  int lost = 0;  // frames missing before this one
};

struct MonitorSettings {
  double stale_periods = 3.0;  // a message older than this many of its periods is stale; 1..1000
  int max_lost = 2;            // 0..13
};

class MessageMonitor {
 public:
  // Throws std::runtime_error that names the message that `bus` lacks. `default_period` stands in where the
  // DBC has no cycle time. `bus` must outlive the monitor.
  MessageMonitor(const dbc::VehicleBus& bus, const MonitorSettings& settings, Time default_period);

  [[nodiscard]] std::variant<Accepted, RxFault> Check(const can::Frame& frame, Time now);

  // Received and not older than `stale_periods` of its periods.
  [[nodiscard]] bool Fresh(RxMessage message, Time now) const;
  // Time since the last accepted frame; Time::max() before the first.
  [[nodiscard]] Time Age(RxMessage message, Time now) const;
  [[nodiscard]] Time StaleAfter(RxMessage message) const;
  // A frame of this message failed within the time after which it would be stale.
  [[nodiscard]] bool RecentlyRejected(RxMessage message, Time now) const;

  [[nodiscard]] std::uint64_t count(RxFault fault) const { return counts_[static_cast<std::size_t>(fault)]; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }  // frames, of all messages
  // CAN identifiers of the received messages, for the socket's filter.
  [[nodiscard]] std::array<std::uint32_t, kRxMessages> Ids() const;

 private:
  struct Entry {
    std::uint32_t id = 0;
    Time stale_after{};
    bool received = false;       // a counter is known
    bool accepted = false;       // a frame was accepted
    std::uint8_t counter = 0;    // of the last frame with a good CRC
    int in_sequence_wanted = 0;  // frames in sequence before the message is believed again
    Time last{};                 // of the last accepted frame
    bool rejected = false;
    Time last_rejected{};
  };

  // Nothing if the frame passes; `lost` is set then.
  [[nodiscard]] std::optional<RxFault> Judge(Entry& entry, const can::Frame& frame, std::uint8_t& counter,
                                             int& lost);

  const dbc::VehicleBus* bus_;
  int max_lost_;
  std::array<Entry, kRxMessages> table_{};
  std::array<std::uint64_t, kRxFaults> counts_{};
  std::uint64_t lost_ = 0;
};

}  // namespace lpvmpcd
