#include "control/road/path_stop.hpp"

#include <algorithm>
#include <cmath>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/steady_cornering.hpp"

namespace control {

double PathStop::OffsetOf(std::span<const State> plan, const RouteMotion& motion) const {
  const Eigen::Vector2d end = Position(plan.back());
  const State z = reference_->At(NearestAhead(*reference_, end, motion.nearest));
  return LeftOf(z[kPsi]).dot(end - Position(z));
}

double PathStop::Steering(const RouteMotion& motion, double offset, double applied) const {
  constexpr int kMostSamples = 2000;
  if (motion.speed < kMinSteeringSpeed) {
    return applied;
  }
  const double look_ahead = std::max(settings_.look_ahead_time * motion.speed, settings_.min_look_ahead);
  Eigen::Vector2d to_target = Eigen::Vector2d::Zero();
  for (int k = motion.nearest; k < motion.nearest + kMostSamples && to_target.norm() < look_ahead; ++k) {
    const State z = reference_->At(k);
    to_target = Beside(z, offset) - motion.p;
  }
  const double curvature = 2.0 * LeftOf(motion.travel_direction).dot(to_target) / to_target.squaredNorm();
  const double step = settings_.max_steering_rate * settings_.t_s;
  return std::clamp(curvature * SteeringPerCurvature(settings_.vehicle, motion.speed), applied - step,
                    applied + step);
}

}  // namespace control
