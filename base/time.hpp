// Time inside the daemon: an argument everywhere, read from a clock by the service alone.
#pragma once

#include <algorithm>
#include <chrono>

namespace base {

// Since an arbitrary start, never going back: CLOCK_MONOTONIC on a real bus, steps times the period in lock
// step.
using Time = std::chrono::nanoseconds;

[[nodiscard]] constexpr Time FromSeconds(double seconds) {
  return std::chrono::round<Time>(std::chrono::duration<double>(seconds));
}

[[nodiscard]] constexpr double ToSeconds(Time time) {
  return std::chrono::duration<double>(time).count();
}

[[nodiscard]] constexpr double Milliseconds(Time time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

// When a frame arrived. The kernel stamps frames by a clock that may be set at any time, so the age that this clock
// tells is believed only within what is certain: not later than now, not before the queue was last seen empty.
[[nodiscard]] constexpr Time ArrivalTime(Time now, Time age, Time last_empty) {
  return std::clamp(now - age, std::min(last_empty, now), now);
}

}  // namespace base
