#include "control/road/progress_reference.hpp"

#include <algorithm>
#include <cmath>

#include "control/vehicle/steady_cornering.hpp"

namespace control {
namespace {

// Difference from the profile up to which the reference ignores the measured speed, so that noise does not become an
// acceleration [m/s].
constexpr double kSpeedTolerance = 0.5;
// Multiple of the comfortable deceleration at which the vehicle brakes to catch up with a profile.
constexpr double kHarder = 1.5;
// Speed reduction below that of a moving stop line, per metre beyond it [1/s].
constexpr double kFallBack = 0.5;

}  // namespace

double ProgressReference::SpeedAt(double s, double t, std::span<const StopLine> stops) const {
  double speed = profile_->At(s).speed;
  for (const StopLine& stop : stops) {
    const double distance = stop.s + stop.speed * t - s;
    const double over =
        distance < 0.0 ? kFallBack * distance : StoppingSpeed(distance, profile_->limits().deceleration);
    speed = std::min(speed, std::max(stop.speed + over, 0.0));
  }
  return speed;
}

// The vehicle brakes a little harder than comfortable to catch up with a profile, and as hard as necessary before a
// near stop line.
double ProgressReference::Deceleration(double s, double upsilon, std::span<const StopLine> stops) const {
  const SpeedLimits& limits = profile_->limits();
  double hardest = kHarder * limits.deceleration;
  for (const StopLine& stop : stops) {
    const double closing = std::max(upsilon - stop.speed, 0.0);
    const double needed = closing * closing / (2.0 * std::max(stop.s - s, RoadProfile::kStopWithin));
    hardest = std::max(hardest, std::min(needed, limits.emergency));
  }
  return hardest;
}

void ProgressReference::Fill(double s_0, double upsilon, std::span<const StopLine> stops, std::span<State> z,
                             std::span<Input> u, std::span<double> s) const {
  const double up = profile_->limits().acceleration * t_s_;
  const double down = Deceleration(s_0, upsilon, stops) * t_s_;

  double place = s_0;
  double speed = std::clamp(SpeedAt(place, 0.0, stops), std::max(upsilon - kSpeedTolerance, 0.0),
                            std::max(upsilon, 0.0) + kSpeedTolerance);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const RoutePoint point = profile_->At(place);
    const double lever = SideslipPerCurvature(vehicle_, speed);
    z[i] << point.X, point.Y, speed, point.curvature * speed * lever, point.psi - point.curvature * lever,
        point.curvature * speed;
    s[i] = place;
    if (i == u.size()) break;
    const double t = static_cast<double>(i + 1) * t_s_;
    const double next =
        std::clamp(SpeedAt(place + speed * t_s_, t, stops), std::max(speed - down, 0.0), speed + up);
    u[i] << point.curvature * SteeringPerCurvature(vehicle_, speed), (next - speed) / t_s_;
    place += 0.5 * (speed + next) * t_s_;
    speed = next;
  }
}

}  // namespace control
