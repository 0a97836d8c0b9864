#include "control/road/odometer.hpp"

#include <algorithm>
#include <cmath>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/steady_cornering.hpp"

namespace control {

int NearestAhead(const TimeReference& reference, const Eigen::Vector2d& p, int from) {
  constexpr int kMostSamples = 2000;
  const auto distance = [&](int k) { return (p - Position(reference.At(k))).norm(); };
  return NearestSample(distance, from, from, from + kMostSamples);
}

void Odometer::Start(const State& z, int k) {
  motion_.nearest = k;
  Advance(&z, Input::Zero());
}

void Odometer::Advance(const State* measured, const Input& applied) {
  RouteMotion& m = motion_;
  if (measured != nullptr) {
    const State& z = *measured;
    m.p = Position(z);
    m.psi = z[kPsi];
    m.speed = z.segment<2>(kUpsilon).norm();
    m.travel_direction = m.psi + (m.speed > kMinSteeringSpeed ? std::atan2(z[kNu], z[kUpsilon]) : 0.0);
  } else {
    const double curvature = applied[kDelta] / SteeringPerCurvature(vehicle_, m.speed);
    const double next = std::max(m.speed + t_s_ * applied[kAcceleration], 0.0);
    const double way = 0.5 * (m.speed + next) * t_s_;
    m.psi += 0.5 * way * curvature;
    m.p += way * Along(m.psi + curvature * SideslipPerCurvature(vehicle_, m.speed));
    m.psi += 0.5 * way * curvature;
    m.speed = next;
    m.travel_direction = m.psi + curvature * SideslipPerCurvature(vehicle_, m.speed);
  }
  m.nearest = NearestAhead(*reference_, m.p, m.nearest);
}

}  // namespace control
