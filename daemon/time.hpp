// Time inside the daemon: an argument everywhere, read from a clock by the service alone.
#pragma once

#include <chrono>

namespace lpvmpcd {

// Since an arbitrary start, never going back: CLOCK_MONOTONIC on a real bus, steps times the period in lock
// step.
using Time = std::chrono::nanoseconds;

[[nodiscard]] constexpr Time FromSeconds(double seconds) {
  return std::chrono::round<Time>(std::chrono::duration<double>(seconds));
}

[[nodiscard]] constexpr double ToSeconds(Time time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace lpvmpcd
