#include "control/traffic/progress_reference.hpp"

#include <algorithm>
#include <cmath>

#include "control/road/projection.hpp"
#include "control/vehicle/steady_cornering.hpp"

namespace control {
namespace {

// Difference from the profile up to which the reference ignores the measured speed, so that noise does not become an
// acceleration [m/s].
constexpr double kSpeedTolerance = 0.5;
// Multiple of the comfortable deceleration at which the vehicle brakes to catch up with a profile.
constexpr double kHarder = 1.5;
// Time in which it makes up for a limit that it exceeds [s].
constexpr double kCatchUp = 0.5;
// Least length of the path per length of the road, on the inside of a bend.
constexpr double kLeastStretch = 0.2;

}  // namespace

double ProgressReference::SpeedAt(double s, double t, const Manoeuvre& manoeuvre) const {
  const double limit = std::min(profile_->SpeedWithin(grip_, s), manoeuvre.SpeedLimitAt(s));
  return std::min(limit,
                  SpeedBefore(manoeuvre.stops(), s, t, limits_.deceleration, HardDeceleration(limits_)));
}

// The vehicle brakes a little harder than comfortable to catch up with a profile, and as hard as necessary before a
// near stop line.
double ProgressReference::Deceleration(double s, double upsilon, const Manoeuvre& manoeuvre) const {
  // A limit that has just come, because of one who cuts in, say, leaves less time.
  const double excess = std::max(upsilon - manoeuvre.SpeedLimitAt(s), 0.0);
  double hardest = std::min(kHarder * limits_.deceleration + excess / kCatchUp, limits_.emergency);
  for (const StopLine& stop : manoeuvre.stops()) {
    const double closing = std::max(upsilon - stop.speed, 0.0);
    const double needed =
        closing * closing / (2.0 * std::max(stop.s + stop.spare - s, RoadProfile::kStopWithin));
    const double to_stop = upsilon * upsilon / (2.0 * std::max(stop.RoomToStop(s), RoadProfile::kStopWithin));
    const double most = stop.spare > 0.0 ? std::max(needed, to_stop) : needed;
    hardest = std::max(hardest, std::min(most, limits_.emergency));
  }
  return hardest;
}

void ProgressReference::Fill(double s_0, double upsilon, const Manoeuvre& manoeuvre, std::span<State> z,
                             std::span<Input> u, std::span<double> s, const Disturbance& disturbance,
                             bool slow_down) const {
  const VehicleParameters vehicle = Disturbed(vehicle_, disturbance);
  const double slip = SideslipPerAcceleration(vehicle) * disturbance.a_y;
  const double steering = -UndersteerGradient(vehicle) * disturbance.a_y - disturbance.delta_0;
  const double up = (slow_down ? -limits_.deceleration : limits_.acceleration) * t_s_;
  const double down = Deceleration(s_0, upsilon, manoeuvre) * t_s_;

  double place = s_0;
  double speed = std::clamp(SpeedAt(place, 0.0, manoeuvre), std::max(upsilon - kSpeedTolerance, 0.0),
                            std::max(upsilon, 0.0) + kSpeedTolerance);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const RoutePoint road = profile_->At(place);
    const LateralPoint path = manoeuvre.path.At(place);
    const double stretch = std::max(1.0 - road.curvature * path.offset, kLeastStretch);
    const double theta = std::atan2(path.slope, stretch), cosine = std::cos(theta);
    const double curvature = (path.bend * cosine * cosine / stretch + road.curvature) * cosine / stretch;
    const Eigen::Vector2d point = Beside(road, path.offset);
    const double lever = SideslipPerCurvature(vehicle, speed);
    z[i] << point.x(), point.y(), speed, curvature * speed * lever + speed * slip,
        road.psi + theta - curvature * lever - slip, curvature * speed;
    s[i] = place;
    if (i == u.size()) break;
    const double t = static_cast<double>(i + 1) * t_s_;
    const double along = cosine / stretch * t_s_;
    const double next = std::clamp(SpeedAt(place + speed * along, t, manoeuvre), std::max(speed - down, 0.0),
                                   std::max(speed + up, 0.0));
    u[i] << curvature * SteeringPerCurvature(vehicle, speed) + steering,
        (next - speed) / t_s_ - disturbance.a_x;
    place += 0.5 * (speed + next) * along;
    speed = next;
  }
}

}  // namespace control
