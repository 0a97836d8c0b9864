#include "loop/inbox.hpp"

#include <algorithm>
#include <variant>

namespace loop {
namespace {

using safety::RxMessage;

// Number of cycles without a sent command after which another node is assumed to drive.
constexpr int kSilentPeriods = 40;

}  // namespace

Inbox::Inbox(const bus::VehicleBus& bus, const safety::MonitorSettings& settings, base::Time period)
    : period_(period), monitor_(bus, settings, period), states_(period) {}

bool Inbox::Receive(const can::Frame& frame, base::Time now) {
  const auto verdict = monitor_.Check(frame, now);
  const auto* accepted = std::get_if<safety::Accepted>(&verdict);
  if (accepted == nullptr || !TakeMessage(*accepted, now)) {
    return false;
  }
  completed_ = now;
  steps_.CountState(states_.state().counter);  // here, so that sets that no cycle answers count too
  return true;
}

// True if the message completes a state set.
bool Inbox::TakeMessage(const safety::Accepted& accepted, base::Time now) {
  const bus::Message& message = accepted.message;
  if (const auto* pose = std::get_if<bus::VehiclePose>(&message)) {
    return states_.Update(*pose, accepted.counter, now);
  }
  if (const auto* motion = std::get_if<bus::VehicleMotion>(&message)) {
    return states_.Update(*motion, accepted.counter, now);
  }
  if (const auto* feedback = std::get_if<bus::VehicleFeedback>(&message)) {
    return states_.Update(*feedback, accepted.counter, now);
  }
  if (const auto* position = std::get_if<bus::ObstaclePosition>(&message)) {
    obstacles_.Update(*position);
  } else if (const auto* shape = std::get_if<bus::ObstacleShape>(&message)) {
    obstacles_.Update(*shape);
  } else if (const auto* velocity = std::get_if<bus::ObstacleMotion>(&message)) {
    obstacles_.Update(*velocity);
  } else if (const auto* list = std::get_if<bus::ObstacleList>(&message)) {
    static_cast<void>(obstacles_.Update(*list, now));  // a rejected list lets the obstacles become stale
  } else if (const auto* request = std::get_if<bus::DriverRequest>(&message)) {
    override_seen_ = override_seen_ || request->brake || request->steering_override;
    released_ = released_ || !request->engage;
    request_ = *request;
  }
  return false;
}

Snapshot Inbox::TakeSnapshot(base::Time now, Trigger trigger) {
  if (trigger == Trigger::kTimer) {
    steps_.CountTimer();
  }
  const VehicleState& state = states_.state();
  const auto rejected = [&](RxMessage message) { return monitor_.RecentlyRejected(message, now); };
  Snapshot known{.now = now,
                 .waited = trigger == Trigger::kState ? now - completed_ : base::Time{0},
                 .step = steps_.step(),
                 .state = state,
                 .state_new = trigger == Trigger::kState,
                 .state_fresh = state.complete &&
                                now - state.timestamp <=
                                    std::max(monitor_.StaleAfter(RxMessage::kPose), monitor_.max_state_gap()),
                 .state_rejected = rejected(RxMessage::kPose) || rejected(RxMessage::kMotion) ||
                                   rejected(RxMessage::kFeedback),
                 .obstacles = obstacles_.obstacles(),
                 .obstacle_age = obstacles_.Age(now),
                 .obstacles_fresh = obstacles_.Age(now) <= monitor_.StaleAfter(RxMessage::kObstacleList),
                 .request_fresh = monitor_.Fresh(RxMessage::kDriverRequest, now),
                 .engage = request_.engage,
                 .released = released_,
                 .override_seen = override_seen_ || request_.brake || request_.steering_override,
                 .bus_up = bus_up_,
                 .silent = now - last_up_ > kSilentPeriods * period_,
                 .faulty_message = safety::FindFaultyMessage(monitor_, now)};
  released_ = false;
  override_seen_ = false;
  if (bus_up_) {
    last_up_ = now;
  }
  return known;
}

}  // namespace loop
