#include "control/road/halfspace.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "control/vehicle/geometry.hpp"
#include "control/vehicle/obstacle_geometry.hpp"

namespace control {

std::optional<HalfSpace> ObstacleHalfSpace(const Obstacle& obstacle, const State& z_ref, double margin) {
  using Eigen::Vector2d;
  const Obstacle ellipse = EnclosingEllipse(obstacle);
  // In its axes, scaled by its semi-axes, it is the unit circle.
  const Eigen::Rotation2Dd to_axes(-ellipse.heading);
  const Vector2d axes(ellipse.r_x + margin, ellipse.r_y + margin);
  const Vector2d point = to_axes * Vector2d(z_ref[kX] - ellipse.X, z_ref[kY] - ellipse.Y);
  const Vector2d s = point.cwiseQuotient(axes);
  if (s.squaredNorm() >= 1.0) return std::nullopt;

  const Vector2d left_normal = LeftOf(z_ref[kPsi]);
  const Vector2d d = (to_axes * left_normal).cwiseQuotient(axes);
  // |s + λ d| = 1: λ > 0 is the way out to the left, λ < 0 to the right.
  const double dd = d.squaredNorm(), sd = s.dot(d);
  const double root = std::sqrt(sd * sd + dd * (1.0 - s.squaredNorm()));
  const double left = (-sd + root) / dd, right = (-sd - root) / dd;
  const bool pass_left =
      ellipse.side == PassingSide::kLeft || (ellipse.side == PassingSide::kUnknown && left <= -right);
  const Vector2d q = s + (pass_left ? left : right) * d;

  // The gradient of the ellipse's equation at Q (eq:tangent_param), rotated back into the map.
  const Vector2d normal = (to_axes.inverse() * q.cwiseQuotient(axes)).normalized();
  const Vector2d on_ellipse = Vector2d(ellipse.X, ellipse.Y) + to_axes.inverse() * q.cwiseProduct(axes);
  return HalfSpace{.a = normal.x(), .b = normal.y(), .c = normal.dot(on_ellipse)};
}

}  // namespace control
