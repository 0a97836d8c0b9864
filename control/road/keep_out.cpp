#include "control/road/keep_out.hpp"

#include <algorithm>

#include "control/vehicle/geometry.hpp"
#include "control/vehicle/obstacle_geometry.hpp"

namespace control {
namespace {

using Eigen::Vector2d;

HalfSpace Beyond(const Obstacle& obstacle, const EnlargedObstacle& enlarged, const Vector2d& normal) {
  const double c = normal.dot(Vector2d(obstacle.X, obstacle.Y)) + enlarged.Support(normal);
  return {.a = normal.x(), .b = normal.y(), .c = c};
}

}  // namespace

Obstacle Predict(Obstacle obstacle, double time) {
  obstacle.X += time * obstacle.velocity_X;
  obstacle.Y += time * obstacle.velocity_Y;
  return obstacle;
}

double SupportOf(const Obstacle& obstacle, const Vector2d& direction) {
  return EnlargedObstacle(obstacle).Support(direction);
}

std::optional<HalfSpace> PassingHalfSpace(const Obstacle& obstacle, PassingSide side, const State& z,
                                          const Vector2d& t, const Footprint& footprint, double margin,
                                          double reach) {
  const double sign = side == PassingSide::kLeft ? 1.0 : -1.0;
  const Vector2d n = sign * Vector2d(-t.y(), t.x());
  // Road axes: t along the road, n towards the passing side. From the obstacle's centre, the vehicle covers `rear` to
  // `front` along t. The tangent touches the obstacle's edge over that interval, as near as possible to its widest
  // point.
  const double place = t.dot(Vector2d(z[kX] - obstacle.X, z[kY] - obstacle.Y));
  const double rear = place - footprint.rear, front = place + footprint.front;
  // For most obstacles a circle tells that they are elsewhere along the road.
  constexpr double kRounding = 1e-6;  // [m]
  const double most = EnclosingRadius(obstacle) + std::max(margin, 0.0) + reach + kRounding;
  if (rear >= most || front <= -most) return std::nullopt;
  const EnlargedObstacle enlarged(obstacle, margin);
  const double half_length = enlarged.Support(t);
  if (rear >= half_length + reach || front <= -half_length - reach) return std::nullopt;

  constexpr double kSteepest = 1.0;
  const double slope = std::clamp(enlarged.EdgeSlope(t, n, rear, front), -kSteepest, kSteepest);
  return Beyond(obstacle, enlarged, (n - slope * t).normalized());
}

HalfSpace HalfSpaceBefore(const Obstacle& obstacle, const Vector2d& t, double margin) {
  return Beyond(obstacle, EnlargedObstacle(obstacle, margin), -t);
}

}  // namespace control
