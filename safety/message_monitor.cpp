#include "safety/message_monitor.hpp"

#include <algorithm>
#include <utility>

#include "bus/message_fields.hpp"
#include "dbc/e2e.hpp"

namespace safety {
namespace {

// Names in the DBC, in the order of RxMessage.
constexpr auto kMessageNames = std::to_array<std::string_view>(
    {bus::kFields<bus::VehiclePose>.message, bus::kFields<bus::VehicleMotion>.message,
     bus::kFields<bus::VehicleFeedback>.message, bus::kFields<bus::ObstaclePosition>.message,
     bus::kFields<bus::ObstacleList>.message, bus::kFields<bus::DriverRequest>.message});
static_assert(kMessageNames.size() == kRxMessages);

// Names in the order of RxFault.
constexpr auto kFaultNames = std::to_array<std::string_view>(
    {"unknown id", "wrong kind of frame", "wrong length", "wrong CRC", "invalid counter", "repeated counter",
     "counter jump", "invalid value", "value out of range"});
static_assert(kFaultNames.size() == kRxFaults);

constexpr int kFramesToResynchronise = 2;

}  // namespace

std::string_view Name(RxMessage message) {
  return kMessageNames[static_cast<std::size_t>(message)];
}

std::string_view Name(RxFault fault) {
  return kFaultNames[static_cast<std::size_t>(fault)];
}

MessageMonitor::MessageMonitor(const bus::VehicleBus& bus, const MonitorSettings& settings,
                               base::Time default_period)
    : bus_(&bus) {
  const std::array messages{&bus.Info<bus::VehiclePose>(),     &bus.Info<bus::VehicleMotion>(),
                            &bus.Info<bus::VehicleFeedback>(), &bus.Info<bus::ObstaclePosition>(),
                            &bus.Info<bus::ObstacleList>(),    &bus.Info<bus::DriverRequest>()};
  static_assert(messages.size() == kRxMessages);
  for (std::size_t i = 0; i < kRxMessages; ++i) {
    const double period = messages[i]->period;
    table_[i].info = messages[i];
    table_[i].period = period > 0.0 ? period : base::ToSeconds(default_period);
  }
  Reconfigure(settings);
}

void MessageMonitor::Reconfigure(const MonitorSettings& settings) {
  max_lost_ = settings.max_lost;
  max_state_gap_ = base::FromSeconds(settings.max_state_gap);
  for (Row& row : table_) {
    row.stale_after = base::FromSeconds(settings.stale_periods * row.period);
  }
}

std::variant<Accepted, RxFault> MessageMonitor::Check(const can::Frame& frame, base::Time now) {
  const auto refuse = [this](RxFault fault) {
    ++counts_[static_cast<std::size_t>(fault)];
    return fault;
  };
  if (frame.kind == can::FrameKind::kError) {
    return refuse(RxFault::kWrongKind);  // its id field is not an id
  }
  const auto row =
      std::ranges::find_if(table_, [&frame](const Row& any) { return any.info->id == frame.id; });
  if (row == table_.end()) {
    return refuse(RxFault::kUnknown);
  }
  Accepted accepted{.kind = static_cast<RxMessage>(row - table_.begin())};
  const std::optional<RxFault> fault = Validate(*row, frame, accepted);
  if (fault) {
    row->last_fault = fault;
    row->refused_at = now;
    return refuse(*fault);
  }
  row->accepted_at = now;
  lost_ += static_cast<std::uint64_t>(accepted.lost);
  return accepted;
}

std::optional<RxFault> MessageMonitor::Validate(Row& row, const can::Frame& frame, Accepted& out) const {
  if (frame.kind != can::FrameKind::kData || frame.extended || frame.fd) return RxFault::kWrongKind;

  const bus::E2eCheck check = bus_->Check(frame.id, frame.Payload());
  if (check.verdict == bus::E2eVerdict::kWrongLength) return RxFault::kWrongLength;
  if (check.verdict == bus::E2eVerdict::kWrongCrc) return RxFault::kWrongCrc;
  if (check.verdict != bus::E2eVerdict::kOk) return RxFault::kInvalidCounter;

  // The first frame of a message may have any counter.
  const std::optional<std::uint8_t> before = std::exchange(row.counter, check.counter);
  const int advance =
      before.has_value() ? (check.counter + dbc::kCounterModulus - *before) % dbc::kCounterModulus : 1;
  if (advance == 0) return RxFault::kRepeated;
  const int lost = advance - 1;
  const int allowed = row.in_sequence_wanted > 0 ? 0 : max_lost_;
  row.in_sequence_wanted = lost > allowed ? kFramesToResynchronise : std::max(row.in_sequence_wanted - 1, 0);
  if (row.in_sequence_wanted > 0) return RxFault::kCounterJump;

  if (!bus_->InRange(frame.id, frame.Payload())) return RxFault::kOutOfRange;
  const std::optional<bus::Message> message = bus_->Decode(frame.id, frame.Payload());
  if (!message) return RxFault::kInvalidValue;

  out.message = *message;
  out.counter = check.counter;
  out.lost = lost;
  return std::nullopt;
}

bool MessageMonitor::Fresh(RxMessage message, base::Time now) const {
  return Age(message, now) <= StaleAfter(message);
}

base::Time MessageMonitor::Age(RxMessage message, base::Time now) const {
  const Row& row = RowOf(message);
  return row.accepted_at.has_value() ? now - *row.accepted_at : base::Time::max();
}

base::Time MessageMonitor::StaleAfter(RxMessage message) const {
  return RowOf(message).stale_after;
}

bool MessageMonitor::RecentlyRejected(RxMessage message, base::Time now) const {
  const Row& row = RowOf(message);
  return row.last_fault && now - row.refused_at <= row.stale_after;
}

Health MessageMonitor::HealthOf(RxMessage message, base::Time now) const {
  const Row& row = RowOf(message);
  Health health{.reason = row.last_fault};
  if (Fresh(message, now)) {
    health.state = Health::State::kFresh;
  } else if (RecentlyRejected(message, now)) {
    health.state = Health::State::kRefused;
  } else if (row.accepted_at || row.last_fault) {
    health.state = Health::State::kLate;
  }
  return health;
}

std::array<std::uint32_t, kRxMessages> MessageMonitor::Ids() const {
  std::array<std::uint32_t, kRxMessages> ids{};
  std::ranges::transform(table_, ids.begin(), [](const Row& row) { return row.info->id; });
  return ids;
}

}  // namespace safety
