// Time inside the daemon. It is passed as an argument everywhere; only the service reads a clock.
#pragma once

#include <algorithm>
#include <chrono>

namespace base {

// Time since an arbitrary start, never decreasing: CLOCK_MONOTONIC on a real bus, cycles times the period in lock
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

// Arrival time of a frame. The kernel's timestamps come from a clock that may be set at any time, so the resulting age
// is clamped to what is certain: no later than now, and not before the queue was last seen empty.
[[nodiscard]] constexpr Time ArrivalTime(Time now, Time age, Time last_empty) {
  return std::clamp(now - age, std::min(last_empty, now), now);
}

}  // namespace base
