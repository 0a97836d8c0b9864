#include "sim/route_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"

namespace sim {
namespace {

constexpr double kLargestDrift = 0.25 * std::numbers::pi;  // [rad]

double SpeedBetween(const SpeedPoint& from, const SpeedPoint& to, double time) {
  return std::lerp(from.speed, to.speed, (time - from.time) / (to.time - from.time));
}

double SpeedAt(const std::vector<SpeedPoint>& points, double time) {
  if (time <= points.front().time) return points.front().speed;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (time < points[i].time) return SpeedBetween(points[i - 1], points[i], time);
  }
  return points.back().speed;
}

// The integral of the speed from 0 to `time`.
double DistanceAt(const std::vector<SpeedPoint>& points, double time) {
  double distance = points.front().speed * std::min(time, points.front().time);
  for (std::size_t i = 1; i < points.size() && time > points[i - 1].time; ++i) {
    const SpeedPoint& from = points[i - 1];
    const double until = std::min(time, points[i].time);
    distance += 0.5 * (from.speed + SpeedBetween(from, points[i], until)) * (until - from.time);
  }
  return distance + points.back().speed * std::max(time - points.back().time, 0.0);
}

}  // namespace

void ShiftTo(const RouteMotion& motion, double time, RouteState& state) {
  const std::vector<LateralPoint>& points = motion.lateral;
  const auto next = std::ranges::find_if(points, [time](const LateralPoint& p) { return time < p.time; });
  state.lateral_rate = 0.0;
  if (next == points.begin() || next == points.end()) {
    state.lateral = next == points.end() ? points.back().lateral : points.front().lateral;
    return;
  }
  const LateralPoint& from = *(next - 1);
  const double way = next->lateral - from.lateral, duration = next->time - from.time;
  const double phase = std::numbers::pi * (time - from.time) / duration;
  state.lateral = from.lateral + 0.5 * way * (1.0 - std::cos(phase));
  state.lateral_rate = 0.5 * way * std::sin(phase) * std::numbers::pi / duration;
}

RouteState StateAt(const RouteMotion& motion, double time) {
  RouteState state{.s = motion.s + DistanceAt(motion.speed, time), .speed = SpeedAt(motion.speed, time)};
  ShiftTo(motion, time, state);
  return state;
}

control::Obstacle OnRoute(control::Obstacle object, const control::Route& route, double heading,
                          const RouteState& state) {
  const control::RoutePoint point = route.At(state.s);
  const Eigen::Vector2d centre = control::Beside(point, state.lateral);
  // Off the path, a body with the same rate of s is slower on the inside of a bend and faster on the outside.
  const double along = state.speed * (1.0 - point.curvature * state.lateral);
  const Eigen::Vector2d velocity =
      along * control::Along(point.psi) + state.lateral_rate * control::LeftOf(point.psi);
  const double drift =
      along == 0.0 ? 0.0 : std::clamp(std::atan(state.lateral_rate / along), -kLargestDrift, kLargestDrift);
  object.X = centre.x();
  object.Y = centre.y();
  object.heading = control::WrapAngle(point.psi + heading + drift);
  object.velocity_X = velocity.x();
  object.velocity_Y = velocity.y();
  return object;
}

}  // namespace sim
