#include "control/mpc/plan_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "control/road/keep_out.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {
namespace {

using Eigen::Vector2d;

constexpr double kRoadTolerance = 0.02;  // [m]
constexpr double kGripTolerance = 0.3;   // [m/s²]
constexpr double kSmallest = 1e-3;       // least semi-axis of an obstacle [m]

Vector2d CornerAt(const State& z, const Vector2d& corner) {
  return Position(z) + Rotate(z[kPsi], corner);
}

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

}  // namespace

PlanCheck::PlanCheck(const PlanCheckSettings& settings, const RoadProfile& profile)
    : settings_(settings), model_(BlendedModel(settings.vehicle), settings.t_s), profile_(&profile) {}

// The distance of the outermost corner beyond the road's edge [m]; negative if all corners are on it. Updates `s`.
double PlanCheck::OffRoad(const State& z, double& s) const {
  s = profile_->Project(Position(z), s).s;
  double out = -std::numeric_limits<double>::infinity();
  for (const Vector2d& corner : settings_.footprint.Corners()) {
    const double lateral = profile_->Project(CornerAt(z, corner), s).lateral;
    out = std::max({out, lateral - profile_->road().left, profile_->road().right - lateral});
  }
  return out;
}

double PlanCheck::BeyondGrip(const State& z, const Input& u) const {
  const double across = z[kUpsilon] * z[kOmega];
  return std::hypot(across, u[kAcceleration]) - settings_.mu * kGravity;
}

// In the obstacle's axes, scaled by its semi-axes, the obstacle is the unit circle and the rectangle a parallelogram.
// Returns their overlap, scaled back by the smaller semi-axis [m]; negative if they are apart.
double PlanCheck::Touched(const State& z, const Obstacle& obstacle) const {
  std::array<Vector2d, 4> corners = settings_.footprint.Corners();
  const Eigen::Rotation2Dd to_axes(-obstacle.heading);
  const Vector2d axes = Vector2d(obstacle.r_x, obstacle.r_y).cwiseMax(kSmallest);
  const Vector2d centre(obstacle.X, obstacle.Y);
  for (Vector2d& corner : corners) corner = (to_axes * (CornerAt(z, corner) - centre)).cwiseQuotient(axes);
  double nearest = corners[0].norm();
  bool inside = settings_.footprint.half_width > 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector2d& a = corners[k];
    const Vector2d& b = corners[(k + 1) % corners.size()];
    nearest = std::min(nearest, DistanceToSegment(a, b));
    inside = inside && Cross(b - a, -a) <= 0.0;  // the corners are in clockwise order
  }
  return (inside ? 1.0 + nearest : 1.0 - nearest) * axes.minCoeff();
}

std::optional<ConstraintViolation> PlanCheck::Validate(const State& z, double s, std::span<const Input> u,
                                                       std::span<const Obstacle> obstacles) const {
  State now = z;
  const double off_road = std::max(OffRoad(now, s), 0.0) + kRoadTolerance;
  const double grip = std::max(BeyondGrip(now, Input::Zero()), 0.0) + kGripTolerance;
  for (std::size_t i = 0; i < u.size(); ++i) {
    now = model_.Step(now, u[i]);
    const int step = static_cast<int>(i) + 1;
    for (const Obstacle& obstacle : obstacles) {
      const Obstacle then = Predict(obstacle, step * settings_.t_s);
      const double overlap = Touched(now, then);
      if (overlap > 0.0) {
        return ConstraintViolation{
            .constraint = {.kind = ConstraintKind::kObstacle, .index = obstacle.id, .step = step},
            .amount = overlap};
      }
    }
    const double out = OffRoad(now, s);
    if (out > off_road) {
      return ConstraintViolation{.constraint = {.kind = ConstraintKind::kRoad, .index = 0, .step = step},
                                 .amount = out};
    }
    const double beyond = BeyondGrip(now, u[i]);
    if (beyond > grip) {
      return ConstraintViolation{.constraint = {.kind = ConstraintKind::kFriction, .index = 0, .step = step},
                                 .amount = beyond};
    }
  }
  return std::nullopt;
}

}  // namespace control
