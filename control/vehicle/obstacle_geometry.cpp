#include "control/vehicle/obstacle_geometry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "control/vehicle/geometry.hpp"
#include "control/vehicle/rectangle.hpp"

namespace control {
namespace {

using Eigen::Vector2d;

constexpr double kSmallest = 1e-3;  // smallest semi-axis [m]: a point has no tangent

// The distance from the origin to the segment from a to b.
double DistanceToSegment(const Vector2d& a, const Vector2d& b) {
  const Vector2d d = b - a;
  const double squared = d.squaredNorm();
  const double share = squared > 0.0 ? std::clamp(-a.dot(d) / squared, 0.0, 1.0) : 0.0;
  return (a + share * d).norm();
}

double Cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// In the ellipse's axes, scaled by its semi-axes, it is the unit circle and the rectangle a parallelogram.
double EllipseOverlap(const Obstacle& obstacle, const Footprint& footprint, const State& z) {
  std::array<Vector2d, 4> corners = footprint.Corners();
  const Eigen::Matrix2d to_axes = Eigen::Rotation2Dd(-obstacle.heading).toRotationMatrix();
  const Eigen::Matrix2d to_map = Eigen::Rotation2Dd(z[kPsi]).toRotationMatrix();
  const Vector2d axes = Vector2d(obstacle.r_x, obstacle.r_y).cwiseMax(kSmallest);
  const Vector2d centre(obstacle.X, obstacle.Y);
  for (Vector2d& corner : corners)
    corner = (to_axes * (Position(z) + to_map * corner - centre)).cwiseQuotient(axes);
  double nearest = corners[0].norm();
  bool inside = footprint.half_width > 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector2d& a = corners[k];
    const Vector2d& b = corners[(k + 1) % corners.size()];
    nearest = std::min(nearest, DistanceToSegment(a, b));
    inside = inside && Cross(b - a, -a) <= 0.0;  // the corners are in clockwise order
  }
  return (inside ? 1.0 + nearest : 1.0 - nearest) * axes.minCoeff();
}

// The slope of the edge `ahead` of the widest corner [m], >= 0: first on the arc about that corner, then along the side
// that follows, then on the arc about the side's other end. The side runs `length` [m] further along the road, and its
// outward normal is inclined to the road's by an angle whose sine is `sine`.
double SlopeAhead(double ahead, double margin, double sine, double length) {
  const auto on_arc = [margin](double way) {
    return way < margin ? -way / std::sqrt(margin * margin - way * way)
                        : -std::numeric_limits<double>::infinity();
  };
  if (ahead <= 0.0) return 0.0;
  if (ahead < margin * sine) return on_arc(ahead);
  if (ahead <= margin * sine + length) return -sine / std::sqrt(std::max(1.0 - sine * sine, 0.0));
  return on_arc(ahead - length);
}

}  // namespace

EnlargedObstacle::EnlargedObstacle(const Obstacle& obstacle, double margin)
    : shape_(obstacle.shape),
      axes_(Eigen::Rotation2Dd(obstacle.heading).toRotationMatrix()),
      radii_(obstacle.r_x, obstacle.r_y),
      margin_(margin) {
  if (shape_ == ObstacleShape::kBox) return;
  radii_ = (radii_.array() + margin).max(kSmallest);
  matrix_ = axes_ * radii_.cwiseAbs2().asDiagonal() * axes_.transpose();
}

double EnlargedObstacle::Support(const Vector2d& direction) const {
  if (shape_ == ObstacleShape::kBox) return radii_.dot((axes_.transpose() * direction).cwiseAbs()) + margin_;
  return std::sqrt(direction.dot(matrix_ * direction));
}

double EnlargedObstacle::EdgeSlope(const Vector2d& t, const Vector2d& n, double rear, double front) const {
  return shape_ == ObstacleShape::kBox ? BoxSlope(t, n, rear, front) : EllipseSlope(t, n, rear, front);
}

// The edge is y(τ) = S_tn/S_tt τ + √(det S/S_tt) √(1 − τ²/S_tt).
double EnlargedObstacle::EllipseSlope(const Vector2d& t, const Vector2d& n, double rear, double front) const {
  const Eigen::Matrix2d& S = matrix_;
  const double S_tt = t.dot(S * t), S_tn = t.dot(S * n), S_nn = n.dot(S * n);
  const double tau = std::clamp(S_tn / std::sqrt(S_nn), rear, front);
  const double share = std::clamp(tau / std::sqrt(S_tt), -0.999, 0.999);
  const double root = std::sqrt(std::max(S_tt * S_nn - S_tn * S_tn, 0.0));
  return (S_tn - root * share / std::sqrt(1.0 - share * share)) / S_tt;
}

// Two sides meet in the widest corner. The outward normal of `first` leans back along the road or is square to it; that
// of `second`, a quarter turn on, leans ahead.
double EnlargedObstacle::BoxSlope(const Vector2d& t, const Vector2d& n, double rear, double front) const {
  struct Side {
    Vector2d normal;
    double distance;  // from the centre
  };
  const auto towards_n = [&](int axis) {
    const Vector2d normal = axes_.col(axis);
    return Side{.normal = normal.dot(n) < 0.0 ? Vector2d(-normal) : normal, .distance = radii_[axis]};
  };
  Side first = towards_n(0), second = towards_n(1);
  if (first.normal.dot(t) > second.normal.dot(t)) std::swap(first, second);
  const double back = std::max(-first.normal.dot(t), 0.0), on = std::max(second.normal.dot(t), 0.0);
  const double widest = on * second.distance - back * first.distance;
  const double ahead = std::clamp(widest, rear, front) - widest;
  return ahead >= 0.0 ? SlopeAhead(ahead, margin_, on, 2.0 * first.distance * back)
                      : -SlopeAhead(-ahead, margin_, back, 2.0 * second.distance * on);
}

double Overlap(const Obstacle& obstacle, const Footprint& footprint, const State& z) {
  // Most things are so far away that circles about both tell it.
  const double apart =
      (Position(z) - Vector2d(obstacle.X, obstacle.Y)).norm() - footprint.Reach() - EnclosingRadius(obstacle);
  if (apart > 0.0) return -apart;
  if (obstacle.shape == ObstacleShape::kBox)
    return Overlap(RectangleOf(obstacle), RectangleOf(footprint, Position(z), z[kPsi]));
  return EllipseOverlap(obstacle, footprint, z);
}

double EnclosingRadius(const Obstacle& obstacle) {
  if (obstacle.shape == ObstacleShape::kBox) return std::hypot(obstacle.r_x, obstacle.r_y);
  return std::max({obstacle.r_x, obstacle.r_y, kSmallest});
}

Obstacle EnclosingEllipse(const Obstacle& obstacle) {
  Obstacle ellipse = obstacle;
  if (obstacle.shape == ObstacleShape::kBox) {
    ellipse.shape = ObstacleShape::kEllipse;
    ellipse.r_x *= std::numbers::sqrt2;
    ellipse.r_y *= std::numbers::sqrt2;
  }
  return ellipse;
}

}  // namespace control
