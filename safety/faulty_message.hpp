// Which of the received messages ails: does not come, or is refused for longer than it may be stale.
#pragma once

#include <optional>

#include "safety/message_monitor.hpp"

namespace safety {

struct FaultyMessage {
  RxMessage message{};
  std::optional<RxFault> reason;  // of its refusal; none: it does not come
};

// The first in the order of RxMessage. ObstacleObject may stay away: without obstacles there is none.
[[nodiscard]] std::optional<FaultyMessage> FindFaultyMessage(const MessageMonitor& monitor, base::Time now);

}  // namespace safety
