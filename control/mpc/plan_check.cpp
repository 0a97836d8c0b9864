#include "control/mpc/plan_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/road/keep_out.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/obstacle_geometry.hpp"

namespace control {
namespace {

using Eigen::Vector2d;

constexpr double kRoadTolerance = 0.02;  // [m]
constexpr double kGripTolerance = 0.3;   // [m/s²]
constexpr double kLongestPlan = 3.0;     // time within which objects count [s]
constexpr double kStrongest = 2.0;       // acceleration of the vehicle [m/s²]

Vector2d CornerAt(const State& z, const Vector2d& corner) {
  return Position(z) + Rotate(z[kPsi], corner);
}

}  // namespace

PlanCheck::PlanCheck(const PlanCheckSettings& settings, const RoadProfile& profile)
    : settings_(settings),
      model_(BlendedModel(settings.vehicle), settings.t_s),
      profile_(&profile),
      objects_(settings.footprint, kLongestPlan, profile),
      mu_(settings.mu) {}

// The distance of the outermost corner beyond the road's edge [m]; negative if all corners are on it. Updates `s`.
double PlanCheck::OffRoad(const State& z, double& s) const {
  s = profile_->Project(Position(z), s).s;
  double out = -std::numeric_limits<double>::infinity();
  for (const Vector2d& corner : settings_.footprint.Corners()) {
    const RouteProjection place = profile_->Project(CornerAt(z, corner), s);
    const RoadBounds road = profile_->RoadAt(place.s);
    out = std::max({out, place.lateral - road.left, road.right - place.lateral});
  }
  return out;
}

// The tyres need not give the acceleration a_y of bank and wind.
double PlanCheck::BeyondGrip(const State& z, const Input& u) const {
  const double across = z[kUpsilon] * z[kOmega] - a_y_;
  return std::hypot(across, u[kAcceleration]) - mu_ * kGravity;
}

void PlanCheck::Begin(const State& z, double s, std::span<const Obstacle> obstacles,
                      const Disturbance& disturbance, double mu_limit) {
  model_ = DiscreteModel(BlendedModel(settings_.vehicle, disturbance), settings_.t_s);
  a_y_ = disturbance.a_y;
  mu_ = std::min(settings_.mu, mu_limit);
  const RouteProjection place = profile_->Project(Position(z), s);
  z_ = z;
  s_ = place.s;
  obstacles_ = obstacles;
  objects_.Select(obstacles, {.s = place.s, .lateral = place.lateral, .speed = z[kUpsilon]},
                  kLongestPlan * (std::max(z[kUpsilon], 0.0) + kLongestPlan * kStrongest));
}

std::optional<ConstraintViolation> PlanCheck::Validate(std::span<const Input> u) const {
  State now = z_;
  double s = s_;
  const double off_road = std::max(OffRoad(now, s), 0.0) + kRoadTolerance;
  const double grip = std::max(BeyondGrip(now, Input::Zero()), 0.0) + kGripTolerance;
  for (std::size_t i = 0; i < u.size(); ++i) {
    now = model_.Step(now, u[i]);
    const int step = static_cast<int>(i) + 1;
    for (const RoadObject& object : objects_.objects()) {
      const Obstacle& obstacle = obstacles_[object.index];
      const Obstacle then = Predict(obstacle, object, *profile_, step * settings_.t_s);
      const double overlap = Overlap(then, settings_.footprint, now);
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
