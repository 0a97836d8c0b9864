#include "control/road/keep_out.hpp"

#include <algorithm>
#include <cmath>

#include "control/vehicle/geometry.hpp"

namespace control {
namespace {

using Eigen::Vector2d;

constexpr double kSmallest = 1e-3;  // smallest semi-axis [m]: a point has no tangent

// Points p with (p − centre)ᵀ S⁻¹ (p − centre) ≤ 1; the support in direction d is √(dᵀ S d).
Eigen::Matrix2d ShapeOf(const Obstacle& obstacle, double margin) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(obstacle.heading).toRotationMatrix();
  const Vector2d axes = (Vector2d(obstacle.r_x, obstacle.r_y).array() + margin).max(kSmallest);
  return R * axes.cwiseAbs2().asDiagonal() * R.transpose();
}

HalfSpace Beyond(const Obstacle& obstacle, const Eigen::Matrix2d& S, const Vector2d& normal) {
  const double c = normal.dot(Vector2d(obstacle.X, obstacle.Y)) + std::sqrt(normal.dot(S * normal));
  return {.a = normal.x(), .b = normal.y(), .c = c};
}

}  // namespace

Obstacle Predict(Obstacle obstacle, double time) {
  obstacle.X += time * obstacle.velocity_X;
  obstacle.Y += time * obstacle.velocity_Y;
  return obstacle;
}

double SupportOf(const Obstacle& obstacle, const Vector2d& direction) {
  return std::sqrt(direction.dot(ShapeOf(obstacle, 0.0) * direction));
}

std::optional<HalfSpace> PassingHalfSpace(const Obstacle& obstacle, PassingSide side, const State& z,
                                          double psi_road, const Footprint& footprint, double margin,
                                          double reach) {
  const Vector2d t = Along(psi_road);
  const double sign = side == PassingSide::kLeft ? 1.0 : -1.0;
  const Vector2d n = sign * LeftOf(psi_road);
  // Road axes: t along the road, n towards the passing side. From the obstacle's centre, the vehicle covers `rear` to
  // `front` along t. The tangent touches the ellipse's edge over that interval, as near as possible to its widest
  // point.
  const Eigen::Matrix2d S = ShapeOf(obstacle, margin);
  const double S_tt = t.dot(S * t), S_tn = t.dot(S * n), S_nn = n.dot(S * n);
  const double place = t.dot(Vector2d(z[kX] - obstacle.X, z[kY] - obstacle.Y));
  const double rear = place - footprint.rear, front = place + footprint.front;
  const double half_length = std::sqrt(S_tt);
  if (rear >= half_length + reach || front <= -half_length - reach) return std::nullopt;

  // The edge is y(τ) = S_tn/S_tt τ + √(det S/S_tt) √(1 − τ²/S_tt).
  constexpr double kSteepest = 1.0;  // |dy/dτ|
  const double tau = std::clamp(S_tn / std::sqrt(S_nn), rear, front);
  const double share = std::clamp(tau / half_length, -0.999, 0.999);
  const double root = std::sqrt(std::max(S_tt * S_nn - S_tn * S_tn, 0.0));
  const double slope = (S_tn - root * share / std::sqrt(1.0 - share * share)) / S_tt;
  const Vector2d normal = (n - std::clamp(slope, -kSteepest, kSteepest) * t).normalized();
  return Beyond(obstacle, S, normal);
}

HalfSpace HalfSpaceBefore(const Obstacle& obstacle, double psi_road, double margin) {
  return Beyond(obstacle, ShapeOf(obstacle, margin), -Along(psi_road));
}

}  // namespace control
