#include "control/road/path_stop.hpp"

#include <algorithm>
#include <cmath>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/steady_cornering.hpp"

namespace control {
namespace {

constexpr int kMostPoints = 2000;  // looked at on the way along the reference

}  // namespace

PathStop::PathStop(const PathStopSettings& settings, const TimeReference& reference)
    : settings_(settings), reference_(&reference) {}

void PathStop::Start(const State& z, int k) {
  k_ = k;
  Advance(&z, Input::Zero());
  offset_ = LeftOf(At(k_)[kPsi]).dot(p_ - Position(At(k_)));
}

void PathStop::Advance(const State* measured, const Input& applied) {
  if (measured != nullptr) {
    const State& z = *measured;
    p_ = Position(z);
    psi_ = z[kPsi];
    speed_ = z.segment<2>(kUpsilon).norm();
    course_ = psi_ + (speed_ > settings_.min_steering_speed ? std::atan2(z[kNu], z[kUpsilon]) : 0.0);
  } else {
    const double curvature = applied[kDelta] / SteeringPerCurvature(settings_.vehicle, speed_);
    const double next = std::max(speed_ + settings_.t_s * applied[kAcceleration], 0.0);
    const double way = 0.5 * (speed_ + next) * settings_.t_s;
    psi_ += 0.5 * way * curvature;
    p_ += way * Along(psi_ + curvature * SideslipPerCurvature(settings_.vehicle, speed_));
    psi_ += 0.5 * way * curvature;
    speed_ = next;
    course_ = psi_ + curvature * SideslipPerCurvature(settings_.vehicle, speed_);
  }
  k_ = Nearest(p_, k_);
}

void PathStop::Follow(std::span<const State> plan) {
  const Eigen::Vector2d end = Position(plan.back());
  const State z = At(Nearest(end, k_));
  offset_ = LeftOf(z[kPsi]).dot(end - Position(z));
}

double PathStop::Steering(double applied) const {
  if (speed_ < settings_.min_steering_speed) {
    return applied;
  }
  const double look_ahead = std::max(settings_.look_ahead_time * speed_, settings_.min_look_ahead);
  Eigen::Vector2d to_target = Eigen::Vector2d::Zero();
  for (int k = k_; k < k_ + kMostPoints && to_target.norm() < look_ahead; ++k) {
    const State z = At(k);
    to_target = Position(z) + offset_ * LeftOf(z[kPsi]) - p_;
  }
  const double curvature = 2.0 * LeftOf(course_).dot(to_target) / to_target.squaredNorm();
  const double step = settings_.max_steering_rate * settings_.t_s;
  return std::clamp(curvature * SteeringPerCurvature(settings_.vehicle, speed_), applied - step,
                    applied + step);
}

State PathStop::At(int k) const {
  State z;
  reference_->Window(k, {&z, 1});
  return z;
}

int PathStop::Nearest(const Eigen::Vector2d& p, int from) const {
  const auto distance = [&](int k) { return (p - Position(At(k))).norm(); };
  return NearestSample(distance, from, from, from + kMostPoints);
}

}  // namespace control
