// The first received message that is missing, or refused for longer than it stays fresh.
#pragma once

#include <optional>

#include "safety/message_monitor.hpp"

namespace safety {

struct FaultyMessage {
  RxMessage message{};
  std::optional<RxFault> reason;  // why it is refused; none: it is missing
};

// The first one in the order of RxMessage. A missing ObstacleObject is no fault: without obstacles none is sent.
[[nodiscard]] std::optional<FaultyMessage> FindFaultyMessage(const MessageMonitor& monitor, base::Time now);

}  // namespace safety
