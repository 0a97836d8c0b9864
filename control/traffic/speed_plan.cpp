#include "control/traffic/speed_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {
namespace {

constexpr double kFallBack =
    0.2;  // speed reduction below that of a moving stop line, per metre beyond it [1/s]
constexpr double kStands = 0.05;  // [m/s]

}  // namespace

double SpeedBefore(std::span<const StopLine> stops, double s, double t, double deceleration, double hard) {
  double speed = std::numeric_limits<double>::infinity();
  for (const StopLine& stop : stops) {
    const double distance = stop.s + stop.speed * t - s;
    const double over = distance < 0.0 ? kFallBack * distance : StoppingSpeed(distance, deceleration);
    const double in_time = stop.spare > 0.0 ? StoppingSpeed(stop.RoomToStop(s) + stop.speed * t, hard)
                                            : std::numeric_limits<double>::infinity();
    speed = std::min({speed, std::max(stop.speed + over, 0.0), in_time});
  }
  return speed;
}

void LimitInTime(const Stations& stations, StationValues& limit, double deceleration) {
  for (std::size_t j = kStations - 1; j-- > 0;) {
    limit[j] =
        std::min(limit[j], std::sqrt(limit[j + 1] * limit[j + 1] + 2.0 * deceleration * stations.Step(j)));
  }
}

SpeedPlan PlanSpeed(const Stations& stations, const StationValues& allowed, std::span<const StopLine> stops,
                    double speed, const SpeedLimits& limits, double time) {
  StationValues limit = allowed;
  LimitInTime(stations, limit, limits.deceleration);
  SpeedPlan plan;
  plan.v[0] = std::max(speed, 0.0);
  plan.count = 1;
  for (std::size_t j = 0; j + 1 < kStations; ++j) {
    const double v = plan.v[j], ds = stations.Step(j);
    const double guess = plan.t[j] + ds / std::max(v, 1.0);
    const double wanted = std::min(limit[j + 1], SpeedBefore(stops, stations.At(j + 1), guess,
                                                             limits.deceleration, HardDeceleration(limits)));
    const double slowest = std::sqrt(std::max(v * v - 2.0 * limits.emergency * ds, 0.0));
    const double fastest = std::sqrt(v * v + 2.0 * limits.acceleration * ds);
    const double next = std::clamp(wanted, slowest, fastest);
    plan.excess = std::max(plan.excess, next - wanted);
    if (v + next < 2.0 * kStands) break;
    plan.v[j + 1] = next;
    plan.t[j + 1] = plan.t[j] + 2.0 * ds / (v + next);
    if (plan.t[j + 1] > time) break;
    plan.count = j + 2;
  }
  return plan;
}

}  // namespace control
