// The speed and the time of arrival at each station: as fast as the limits of speed, stop lines and acceleration allow.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "control/road/road_profile.hpp"
#include "control/road/stations.hpp"
#include "control/traffic/stop_line.hpp"

namespace control {

struct SpeedPlan {
  StationValues v{};  // speed [m/s]
  StationValues t{};  // time of arrival [s], from now; meaningless at stations that are not reached
  std::size_t count =
      0;  // number of stations reached within the time; the vehicle stands or waits at the last one
  double excess = 0.0;  // largest speed above a limit that braking at `limits.emergency` leaves [m/s]
};

// The highest speed at arc length s and time t [s] before the stop lines; beyond a line, the vehicle falls back. [m/s]
// `hard`: deceleration with which the vehicle could stop if a line's object braked at its hardest [m/s²].
[[nodiscard]] double SpeedBefore(std::span<const StopLine> stops, double s, double t, double deceleration,
                                 double hard);

// The deceleration that the vehicle counts on for that [m/s²].
[[nodiscard]] inline double HardDeceleration(const SpeedLimits& limits) {
  return std::min(2.0 * limits.deceleration, 0.75 * limits.emergency);
}

// Lowers the limits so that braking at `deceleration` [m/s²] meets each of them in time. [m/s]
void LimitInTime(const Stations& stations, StationValues& limit, double deceleration);

// `allowed`: speed limit at each station [m/s]. `speed`: present speed [m/s]. Stations later than `time` [s] are not
// reached.
[[nodiscard]] SpeedPlan PlanSpeed(const Stations& stations, const StationValues& allowed,
                                  std::span<const StopLine> stops, double speed, const SpeedLimits& limits,
                                  double time);

}  // namespace control
