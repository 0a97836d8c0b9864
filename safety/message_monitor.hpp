// Validates every received frame before any of its values is used. A frame that fails changes no value and does not
// make its message fresh. The monitor has one table with a row per message, filled from the DBC. A frame must
// satisfy, in this order (an error frame is kWrongKind whatever its id):
//
//   requirement                                   source                          otherwise
//   an id of the table                            BO_                             kUnknown
//   a standard data frame of classic CAN                                          kWrongKind
//   the length                                    BO_                             kWrongLength
//   the CRC over data id and payload              E2EDataId                       kWrongCrc
//   a counter from 0 to 14                                                        kInvalidCounter
//   a counter that differs from the last frame's                                  kRepeated
//   at most max_lost counters skipped             max_lost                        kCounterJump
//   every value finite and within min..max        SG_ ... [min|max]               kOutOfRange
//   a known multiplexor and known enumerators     SG_ ... m0, bus/messages.hpp    kInvalidValue
//
// A message stays fresh for stale_periods of its period (GenMsgCycleTime) after a frame that passed. After that it is
// late if no frames come, refused if the frames fail.
//
// The counter of a message increments by one, modulo 15, from frame to frame. Up to `max_lost` frames may be missing
// between two accepted ones (AUTOSAR E2E profile 1: MaxDeltaCounter). After a larger jump, frames are accepted again
// from the second one that follows in sequence. The first frame of a message is accepted with any counter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "base/time.hpp"
#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"

namespace safety {

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
// The name in the DBC.
[[nodiscard]] std::string_view Name(RxMessage message);

enum class RxFault : std::uint8_t {
  kUnknown,         // no received message has this id
  kWrongKind,       // a known id, but extended, remote or FD; or an error frame
  kWrongLength,     // not the length given by the DBC
  kWrongCrc,        // corrupted payload, or the data id of another message
  kInvalidCounter,  // 15
  kRepeated,        // same counter as the previous frame
  kCounterJump,     // more frames lost than allowed, or not yet in sequence again
  kInvalidValue,    // an unknown multiplexor value, or a value within the range that its enumeration lacks
  kOutOfRange,      // a value outside its range in the DBC, or not finite
};
inline constexpr std::size_t kRxFaults = 9;
[[nodiscard]] std::string_view Name(RxFault fault);

struct Accepted {
  RxMessage kind{};
  bus::Message message{};
  std::uint8_t counter = 0;
  int lost = 0;  // frames missing before this one
};

// Reception state of a message.
struct Health {
  enum class State : std::uint8_t {
    kNeverSeen,  // no frame of it since start
    kFresh,
    kLate,     // frames came, but none recently
    kRefused,  // frames come, but none has passed for as long as a message stays fresh
  };
  State state = State::kNeverSeen;
  std::optional<RxFault> reason;  // fault of the last refused frame; none if no frame was ever refused
};

struct MonitorSettings {
  double stale_periods = 3.0;  // a message older than this many of its periods is stale; 1..1000
  int max_lost = 2;            // frames that may be missing, 0..13
  double max_state_gap = 0.3;  // age of the vehicle's state up to which its model bridges a gap [s], 0..0.5
};

class MessageMonitor {
 public:
  // `default_period` is used for a message without a cycle time in the DBC. `bus` must outlive the monitor.
  MessageMonitor(const bus::VehicleBus& bus, const MonitorSettings& settings, base::Time default_period);

  // Uses these settings from now on.
  void Reconfigure(const MonitorSettings& settings);

  [[nodiscard]] std::variant<Accepted, RxFault> Check(const can::Frame& frame, base::Time now);

  // True if the last accepted frame is not older than `stale_periods` of its message's periods.
  [[nodiscard]] bool Fresh(RxMessage message, base::Time now) const;
  // Time since the last accepted frame; Time::max() before the first.
  [[nodiscard]] base::Time Age(RxMessage message, base::Time now) const;
  [[nodiscard]] base::Time StaleAfter(RxMessage message) const;
  // Age of the vehicle's state up to which its model bridges a gap.
  [[nodiscard]] base::Time max_state_gap() const { return max_state_gap_; }
  // True if a frame of this message was refused within the last StaleAfter().
  [[nodiscard]] bool RecentlyRejected(RxMessage message, base::Time now) const;
  [[nodiscard]] Health HealthOf(RxMessage message, base::Time now) const;

  [[nodiscard]] std::uint64_t count(RxFault fault) const { return counts_[static_cast<std::size_t>(fault)]; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }  // lost frames of all messages
  // CAN identifiers of the received messages, for the socket's filter.
  [[nodiscard]] std::array<std::uint32_t, kRxMessages> Ids() const;

 private:
  struct Row {
    const bus::MessageInfo* info = nullptr;  // id, length, data id
    double period = 0.0;                     // [s]
    base::Time stale_after{};
    // Reception so far.
    std::optional<std::uint8_t> counter;    // counter of the last frame with a valid CRC and counter
    int in_sequence_wanted = 0;             // frames in sequence until the message is accepted again
    std::optional<base::Time> accepted_at;  // time of the last frame that passed
    std::optional<RxFault> last_fault;
    base::Time refused_at{};  // time of the frame of last_fault
  };

  [[nodiscard]] const Row& RowOf(RxMessage message) const {
    return table_[static_cast<std::size_t>(message)];
  }
  // nullopt if the frame passes: then all of `out` except its kind is set.
  [[nodiscard]] std::optional<RxFault> Validate(Row& row, const can::Frame& frame, Accepted& out) const;

  const bus::VehicleBus* bus_;
  int max_lost_ = 0;
  base::Time max_state_gap_{};
  std::array<Row, kRxMessages> table_{};
  std::array<std::uint64_t, kRxFaults> counts_{};
  std::uint64_t lost_ = 0;
};

}  // namespace safety
