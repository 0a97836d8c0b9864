// How often the controller changed its mode after its engagement. Ending the drive at the route's end is no change:
// there, SafeStop and Standby are how it is meant to end.
#pragma once

#include <optional>

#include "bus/messages.hpp"

namespace sim {

class ModeChanges {
 public:
  // The mode of one cycle from engagement on.
  void Take(bus::Mode mode, bus::FaultCode fault) {
    const bool changed = last_ && mode != *last_;
    const bool ends = mode == bus::Mode::kSafeStop || mode == bus::Mode::kStandby;
    last_ = mode;
    if (!changed || (ends && fault == bus::FaultCode::kRouteEnd)) return;
    ++changes_;
    if (mode == bus::Mode::kSafeStop) ++safe_stops_;
  }

  [[nodiscard]] int changes() const { return changes_; }
  [[nodiscard]] int safe_stops() const { return safe_stops_; }

 private:
  std::optional<bus::Mode> last_;
  int changes_ = 0;
  int safe_stops_ = 0;
};

}  // namespace sim
