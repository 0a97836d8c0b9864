#include "safety/faulty_message.hpp"

namespace safety {

std::optional<FaultyMessage> FindFaultyMessage(const MessageMonitor& monitor, base::Time now) {
  for (std::size_t i = 0; i < kRxMessages; ++i) {
    const auto message = static_cast<RxMessage>(i);
    const Health health = monitor.HealthOf(message, now);
    if (health.state == Health::State::kRefused) return FaultyMessage{message, health.reason};
    if (health.state != Health::State::kFresh && message != RxMessage::kObstacleObject) {
      return FaultyMessage{message, std::nullopt};
    }
  }
  return std::nullopt;
}

}  // namespace safety
