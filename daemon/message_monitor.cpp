#include "daemon/message_monitor.hpp"

#include <stdexcept>
#include <string>

#include "dbc/e2e.hpp"

namespace lpvmpcd {
namespace {

// By RxMessage.
constexpr std::array<const char*, kRxMessages> kNames = {"VehiclePose",    "VehicleMotion", "VehicleFeedback",
                                                         "ObstacleObject", "ObstacleList",  "DriverRequest"};
constexpr int kFramesToResynchronise = 2;

}  // namespace

std::string_view Name(RxFault fault) {
  switch (fault) {
    case RxFault::kUnknown:
      return "unknown id";
    case RxFault::kWrongKind:
      return "wrong kind of frame";
    case RxFault::kWrongLength:
      return "wrong length";
    case RxFault::kWrongCrc:
      return "wrong CRC";
    case RxFault::kInvalidCounter:
      return "invalid counter";
    case RxFault::kRepeated:
      return "repeated counter";
    case RxFault::kCounterJump:
      return "counter jump";
    case RxFault::kInvalidValue:
      return "invalid value";
  }
  return "?";
}

MessageMonitor::MessageMonitor(const dbc::VehicleBus& bus, const MonitorSettings& settings,
                               Time default_period)
    : bus_(&bus), max_lost_(settings.max_lost) {
  for (std::size_t i = 0; i < kRxMessages; ++i) {
    const dbc::MessageInfo* info = bus.Find(std::string(kNames[i]));
    if (info == nullptr) {
      throw std::runtime_error(std::string("the DBC lacks the message ") + kNames[i]);
    }
    const double period = info->period > 0.0 ? info->period : ToSeconds(default_period);
    table_[i] = Entry{.id = info->id, .stale_after = FromSeconds(settings.stale_periods * period)};
  }
}

std::variant<Accepted, RxFault> MessageMonitor::Check(const can::Frame& frame, Time now) {
  const auto count = [this](RxFault fault) {
    ++counts_[static_cast<std::size_t>(fault)];
    return fault;
  };
  if (frame.kind == can::FrameKind::kError) {
    return count(RxFault::kWrongKind);
  }
  std::size_t index = 0;
  while (index < kRxMessages && table_[index].id != frame.id) {
    ++index;
  }
  if (index == kRxMessages) {
    return count(RxFault::kUnknown);
  }
  Entry& entry = table_[index];
  Accepted accepted{.kind = static_cast<RxMessage>(index)};
  std::optional<RxFault> fault = Judge(entry, frame, accepted.counter, accepted.lost);
  std::optional<dbc::Message> message;
  if (!fault) {
    message = bus_->Decode(frame.id, frame.Payload());
    fault = message ? std::nullopt : std::optional(RxFault::kInvalidValue);
  }
  if (fault) {
    entry.rejected = true;
    entry.last_rejected = now;
    return count(*fault);
  }
  accepted.message = *message;
  entry.accepted = true;
  entry.last = now;
  lost_ += static_cast<std::uint64_t>(accepted.lost);
  return accepted;
}

std::optional<RxFault> MessageMonitor::Judge(Entry& entry, const can::Frame& frame, std::uint8_t& counter,
                                             int& lost) {
  if (frame.kind != can::FrameKind::kData || frame.extended || frame.fd) {
    return RxFault::kWrongKind;
  }
  const dbc::E2eCheck check = bus_->Check(frame.id, frame.Payload());
  switch (check.verdict) {
    case dbc::E2eVerdict::kOk:
      break;
    case dbc::E2eVerdict::kWrongLength:
      return RxFault::kWrongLength;
    case dbc::E2eVerdict::kWrongCrc:
      return RxFault::kWrongCrc;
    case dbc::E2eVerdict::kInvalidCounter:
      return RxFault::kInvalidCounter;
    case dbc::E2eVerdict::kUnknownMessage:
      return RxFault::kUnknown;
  }
  counter = check.counter;
  if (!entry.received) {
    entry.received = true;
    entry.counter = counter;
    return std::nullopt;
  }
  const int advance = (counter + dbc::kCounterModulus - entry.counter) % dbc::kCounterModulus;
  if (advance == 0) {
    return RxFault::kRepeated;
  }
  entry.counter = counter;
  if (entry.in_sequence_wanted > 0 && advance == 1) {
    --entry.in_sequence_wanted;
  } else if (entry.in_sequence_wanted > 0 || advance - 1 > max_lost_) {
    entry.in_sequence_wanted = kFramesToResynchronise;
  } else {
    lost = advance - 1;
  }
  return entry.in_sequence_wanted > 0 ? std::optional(RxFault::kCounterJump) : std::nullopt;
}

bool MessageMonitor::Fresh(RxMessage message, Time now) const {
  return Age(message, now) <= StaleAfter(message);
}

Time MessageMonitor::Age(RxMessage message, Time now) const {
  const Entry& entry = table_[static_cast<std::size_t>(message)];
  return entry.accepted ? now - entry.last : Time::max();
}

Time MessageMonitor::StaleAfter(RxMessage message) const {
  return table_[static_cast<std::size_t>(message)].stale_after;
}

bool MessageMonitor::RecentlyRejected(RxMessage message, Time now) const {
  const Entry& entry = table_[static_cast<std::size_t>(message)];
  return entry.rejected && now - entry.last_rejected <= entry.stale_after;
}

std::array<std::uint32_t, kRxMessages> MessageMonitor::Ids() const {
  std::array<std::uint32_t, kRxMessages> ids{};
  for (std::size_t i = 0; i < kRxMessages; ++i) {
    ids[i] = table_[i].id;
  }
  return ids;
}

}  // namespace lpvmpcd
