// Judges every received frame before any of its values is used. A frame that fails changes no value and does not make
// its message look fresh. One table, a row a message, filled from the DBC; in this order it is demanded of a frame:
//
//   what                                          told by                         otherwise
//   an id of the table                            BO_                             kUnknown
//   a standard data frame of classic CAN                                          kWrongKind
//   the length                                    BO_                             kWrongLength
//   the CRC over data id and payload              E2EDataId                       kWrongCrc
//   a counter from 0 to 14                                                        kInvalidCounter
//   another counter than the frame before                                         kRepeated
//   few enough counters left out                  max_lost                        kCounterJump
//   every value a number, from min to max         SG_ ... [min|max]               kOutOfRange
//   a multiplexor and enumerations that we know   SG_ ... m0, bus/messages.hpp    kInvalidValue
//
// and of a message: a frame that passes within stale_periods of its period (GenMsgCycleTime), else it is no longer
// fresh: late if none comes, refused if what comes fails.
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
// As in the DBC.
[[nodiscard]] std::string_view Name(RxMessage message);

enum class RxFault : std::uint8_t {
  kUnknown,         // no message of ours has this id
  kWrongKind,       // an id of ours, but extended, remote, FD; or an error frame
  kWrongLength,     // not the length that the DBC tells
  kWrongCrc,        // payload, or data id of another message
  kInvalidCounter,  // 15
  kRepeated,        // same counter as the frame before
  kCounterJump,     // more frames lost than allowed, or not yet in sequence again
  kInvalidValue,    // a multiplexor without such a value, or an enumeration without one that its range allows
  kOutOfRange,      // a value beyond the range that the DBC gives it, or not finite
};
inline constexpr std::size_t kRxFaults = 9;
[[nodiscard]] std::string_view Name(RxFault fault);

struct Accepted {
  RxMessage kind{};
  bus::Message message{};
  std::uint8_t counter = 0;
  int lost = 0;  // frames missing before this one
};

// How a message is received.
struct Health {
  enum class State : std::uint8_t {
    kNeverSeen,  // no frame of it came since start
    kFresh,
    kLate,     // frames came, but none of late
    kRefused,  // frames come, but have been failing for longer than an accepted one stays fresh
  };
  State state = State::kNeverSeen;
  std::optional<RxFault> reason;  // of the last frame that was refused; none if none ever was
};

struct MonitorSettings {
  double stale_periods = 3.0;  // a message older than this many of its periods is stale; 1..1000
  int max_lost = 2;            // 0..13
};

class MessageMonitor {
 public:
  // `default_period` stands in where the DBC has no cycle time. `bus` must outlive the monitor.
  MessageMonitor(const bus::VehicleBus& bus, const MonitorSettings& settings, base::Time default_period);

  // Goes by other settings from now on.
  void Reconfigure(const MonitorSettings& settings);

  [[nodiscard]] std::variant<Accepted, RxFault> Check(const can::Frame& frame, base::Time now);

  // Received and not older than `stale_periods` of its periods.
  [[nodiscard]] bool Fresh(RxMessage message, base::Time now) const;
  // Time since the last accepted frame; Time::max() before the first.
  [[nodiscard]] base::Time Age(RxMessage message, base::Time now) const;
  [[nodiscard]] base::Time StaleAfter(RxMessage message) const;
  // A frame of this message failed within the time after which it would be stale.
  [[nodiscard]] bool RecentlyRejected(RxMessage message, base::Time now) const;
  [[nodiscard]] Health HealthOf(RxMessage message, base::Time now) const;

  [[nodiscard]] std::uint64_t count(RxFault fault) const { return counts_[static_cast<std::size_t>(fault)]; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }  // frames, of all messages
  // CAN identifiers of the received messages, for the socket's filter.
  [[nodiscard]] std::array<std::uint32_t, kRxMessages> Ids() const;

 private:
  struct Row {
    const bus::MessageInfo* info = nullptr;  // id, length, data id
    double period = 0.0;                     // [s]
    base::Time stale_after{};
    // What has come of it.
    std::optional<std::uint8_t> counter;    // of the last frame with a good CRC
    int in_sequence_wanted = 0;             // frames in sequence before the message is believed again
    std::optional<base::Time> accepted_at;  // the last frame that passed
    std::optional<RxFault> last_fault;
    base::Time refused_at{};  // the frame of last_fault
  };

  [[nodiscard]] const Row& RowOf(RxMessage message) const {
    return table_[static_cast<std::size_t>(message)];
  }
  // Nothing if the frame passes: then `out` has all but its kind.
  [[nodiscard]] std::optional<RxFault> Judge(Row& row, const can::Frame& frame, Accepted& out) const;

  const bus::VehicleBus* bus_;
  int max_lost_ = 0;
  std::array<Row, kRxMessages> table_{};
  std::array<std::uint64_t, kRxFaults> counts_{};
  std::uint64_t lost_ = 0;
};

}  // namespace safety
