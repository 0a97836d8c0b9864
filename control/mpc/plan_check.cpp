#include "control/mpc/plan_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/road/keep_out.hpp"
#include "control/traffic/occupancy.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/obstacle_geometry.hpp"
#include "control/vehicle/steady_cornering.hpp"

namespace control {
namespace {

using Eigen::Vector2d;

constexpr double kRoadTolerance = 0.02;  // [m]
constexpr double kGripTolerance = 0.3;   // [m/s²]
constexpr double kLongest = 8.0;         // time within which objects count [s]
constexpr std::size_t kMostSteps = 200;
constexpr double kReserve = 0.5;  // way by which a stop behind a plan may be longer [m]
constexpr double kReach = 30.0;   // way that an acceleration adds within a plan [m]

ConstraintViolation Violation(ConstraintKind kind, int index, int step, double amount) {
  return {.constraint = {.kind = kind, .index = index, .step = step}, .amount = amount};
}

Vector2d CornerAt(const State& z, const Vector2d& corner) {
  return Position(z) + Rotate(z[kPsi], corner);
}

}  // namespace

PlanCheck::PlanCheck(const PlanCheckSettings& settings, const RoadProfile& profile)
    : settings_(settings),
      model_(BlendedModel(settings.vehicle), settings.t_s),
      profile_(&profile),
      objects_(settings.footprint, kLongest, profile),
      mu_(settings.mu),
      path_(settings.vehicle, profile, kMostSteps, settings.footprint.half_width) {
  predicted_.reserve(kMostSteps + 1);
  accelerations_.reserve(kMostSteps);
}

void PlanCheck::Reconfigure(double stop_deceleration) {
  settings_.stop_deceleration = stop_deceleration;
}

// The distance of the outermost corner beyond the road's edge [m], or a bound of it below 0; negative if all corners are on
// the road. Updates `s`.
double PlanCheck::OffRoad(const State& z, double& s) const {
  const RouteProjection centre = profile_->Project(Position(z), s);
  s = centre.s;
  double out = MostOffRoad(z, centre);
  if (out < 0.0) return out;
  out = -std::numeric_limits<double>::infinity();
  for (const Vector2d& corner : settings_.footprint.Corners()) {
    const RouteProjection place = profile_->Project(CornerAt(z, corner), s + corner.x());
    const RoadBounds road = profile_->RoadAt(place.s);
    out = std::max({out, place.lateral - road.left, road.right - place.lateral});
  }
  return out;
}

// An upper bound of that distance which is found without the corners' places on the road: no corner is farther across the
// road than its own distance and that by which vehicle and road turn along the vehicle.
double PlanCheck::MostOffRoad(const State& z, const RouteProjection& centre) const {
  const double reach =
      2.0 * settings_.footprint.Reach();  // in a bend, the road beside the vehicle is longer than it
  const RoadBounds road = profile_->NarrowestRoad(centre.s - reach, centre.s + reach);
  const double turned = std::abs(WrapAngle(z[kPsi] - profile_->At(centre.s).psi));
  const double across = settings_.footprint.half_width +
                        settings_.footprint.Reach() * (turned + profile_->TurnWithin(centre.s, reach));
  return std::max(centre.lateral - road.left, road.right - centre.lateral) + across;
}

// The tyres need not give the acceleration a_y of bank and wind.
double PlanCheck::BeyondGrip(const State& z, const Input& u) const {
  const double across = z[kUpsilon] * z[kOmega] - a_y_;
  return std::hypot(across, TyreDemand(settings_.vehicle, u[kAcceleration])) - mu_ * kGravity;
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
  off_road_ = std::max(OffRoad(z, s_), 0.0) + kRoadTolerance;
  objects_.Select(obstacles, {.s = place.s, .lateral = place.lateral, .speed = z[kUpsilon]},
                  kLongest * std::max(z[kUpsilon], 0.0) + kReach);
  for (std::size_t k = 0; k < objects_.objects().size(); ++k) {
    const RoadObject& object = objects_.objects()[k];
    const Obstacle& obstacle = obstacles_[object.index];
    reach_[k] = {.centre = {obstacle.X, obstacle.Y},
                 .far = object.half_length + object.half_width + settings_.footprint.Reach(),
                 .stands = obstacle.velocity_X == 0.0 && obstacle.velocity_Y == 0.0,
                 .touched = Overlap(obstacle, settings_.footprint, z) > 0.0};
  }
}

std::optional<ConstraintViolation> PlanCheck::Validate(std::span<const Input> u) {
  State now = z_;
  double s = s_;
  predicted_.assign(1, z_);
  accelerations_.clear();
  const double grip = std::max(BeyondGrip(now, Input::Zero()), 0.0) + kGripTolerance;
  for (std::size_t i = 0; i < std::min(u.size(), kMostSteps); ++i) {
    now = model_.Step(now, u[i]);
    const int step = static_cast<int>(i) + 1;
    for (std::size_t k = 0; k < objects_.objects().size(); ++k) {
      const Reach& reach = reach_[k];
      if (reach.stands && (Position(now) - reach.centre).squaredNorm() > reach.far * reach.far) continue;
      const RoadObject& object = objects_.objects()[k];
      const Obstacle& obstacle = obstacles_[object.index];
      const Obstacle then = Predict(obstacle, object, *profile_, step * settings_.t_s);
      const double overlap = Overlap(then, settings_.footprint, now);
      if (overlap > 0.0) return Violation(ConstraintKind::kObstacle, obstacle.id, step, overlap);
    }
    const double out = OffRoad(now, s);
    if (out > off_road_) return Violation(ConstraintKind::kRoad, 0, step, out);
    const double beyond = BeyondGrip(now, u[i]);
    if (beyond > grip) return Violation(ConstraintKind::kFriction, 0, step, beyond);
    predicted_.push_back(now);
    accelerations_.push_back(u[i][kAcceleration]);
  }
  return std::nullopt;
}

StopVerdict PlanCheck::FindStop(const LateralPath& beyond) {
  constexpr double kLasts = 0.5;  // [s]
  const std::size_t steps = accelerations_.size();
  path_.Follow(predicted_, s_, beyond);
  StopVerdict verdict;
  std::size_t checked = 0;  // steps in which the others may do what they can
  double s = s_;
  for (const std::size_t after : {std::size_t{1}, steps / 2, steps}) {
    if (after > steps || after <= checked) continue;
    std::optional<ConstraintViolation> contact;
    if (!ClearUntil(after, checked, s, contact)) {
      if (!verdict.violation) verdict.violation = contact;
      return verdict;
    }
    StopVerdict stop = StopAfter(after, s);
    if (stop.deceleration) {
      const std::size_t later = std::min(1 + static_cast<std::size_t>(kLasts / settings_.t_s), steps);
      stop.lasts = after > 1 || (ClearUntil(later, checked, s, contact) && StopAfter(later, s).deceleration);
      return stop;
    }
    if (after == 1) verdict = stop;
  }
  return verdict;
}

bool PlanCheck::ClearUntil(std::size_t after, std::size_t& checked, double& s,
                           std::optional<ConstraintViolation>& contact) const {
  for (; checked < after; ++checked) {
    const State& z = predicted_[checked + 1];
    s = profile_->Project(Position(z), s).s;
    contact = Contact(z, s, static_cast<double>(checked + 1) * settings_.t_s);
    if (contact) return false;
  }
  return true;
}

StopVerdict PlanCheck::StopAfter(std::size_t after, double s) const {
  const State& z = predicted_[after];
  return Mildest(path_,
                 {.distance = path_.DistanceOf(Position(z), s),
                  .speed = z[kUpsilon],
                  .acceleration = accelerations_[after - 1],
                  .time = static_cast<double>(after) * settings_.t_s},
                 kReserve);
}

StopVerdict PlanCheck::FindStop(const StopPath& path, double acceleration) const {
  const Braking from{
      .distance = path.DistanceOf(Position(z_), s_), .speed = z_[kUpsilon], .acceleration = acceleration};
  return Mildest(path, from, 0.0);
}

StopVerdict PlanCheck::Mildest(const StopPath& path, const Braking& from, double reserve) const {
  StopVerdict verdict;
  for (const double deceleration : {settings_.stop_deceleration, settings_.hardest_deceleration}) {
    verdict.violation = Brake(path, from, deceleration, reserve);
    if (!verdict.violation) return {.deceleration = deceleration, .violation = {}};
  }
  return verdict;
}

int PlanCheck::StepAt(double time) const {
  return static_cast<int>(std::lround(time / settings_.t_s));
}

// The first contact that is possible with a vehicle at `z`, beside the road's arc length s, `time` later.
std::optional<ConstraintViolation> PlanCheck::Contact(const State& z, double s, double time) const {
  for (std::size_t k = 0; k < objects_.objects().size(); ++k) {
    const Reach& reach = reach_[k];
    // Most things stand, far from the vehicle's way.
    if (reach.stands && (Position(z) - reach.centre).squaredNorm() > reach.far * reach.far) continue;
    if (reach.touched) continue;
    const RoadObject& object = objects_.objects()[k];
    const Obstacle& obstacle = obstacles_[object.index];
    const double after = TimeToNearest(obstacle, object, time, Position(z), s, s_);
    if (!object.crosses && std::abs(object.SAt(after) - s) > reach.far) continue;
    const Obstacle then = Predict(obstacle, object, *profile_, after);
    if ((Position(z) - Vector2d(then.X, then.Y)).squaredNorm() > reach.far * reach.far) continue;
    const double overlap = Overlap(then, settings_.footprint, z);
    if (overlap > 0.0) return Violation(ConstraintKind::kObstacle, obstacle.id, StepAt(time), overlap);
  }
  return std::nullopt;
}

double PlanCheck::Deceleration(const StopPath& path, const std::optional<double>& stop) const {
  return Brakes(z_[kUpsilon], path.At(path.DistanceOf(Position(z_), s_)).curvature,
                stop.value_or(settings_.hardest_deceleration));
}

// The tyres brake with what the bend leaves them, but always a little [m/s²].
double PlanCheck::Brakes(double speed, double curvature, double deceleration) const {
  constexpr double kShare = 0.95;  // of the grip that braking may use
  constexpr double kLeast = 0.5;   // [m/s²]
  const double across = speed * speed * curvature - a_y_, most = kShare * mu_ * kGravity;
  return std::min(deceleration, std::max(std::sqrt(std::max(most * most - across * across, 0.0)), kLeast));
}

// The first violation while the vehicle brakes along the path until it stands, and where it would be `reserve` [m] further.
std::optional<ConstraintViolation> PlanCheck::Brake(const StopPath& path, Braking from, double deceleration,
                                                    double reserve) const {
  constexpr double kStep = 0.1;      // [s]
  constexpr double kResponse = 0.1;  // time until the brakes respond [s]
  constexpr double kStands = 0.1;    // [m/s]
  const double begin = from.time, grip = mu_ * kGravity;
  const auto clear = [&](double distance) -> std::optional<ConstraintViolation> {
    const StopPathPoint point = path.At(distance);
    State z = State::Zero();
    z[kX] = point.p.x();
    z[kY] = point.p.y();
    z[kPsi] = point.direction - point.curvature * SideslipPerCurvature(settings_.vehicle, from.speed);
    if (const auto contact = Contact(z, point.s, from.time)) return contact;
    double s = point.s;
    const double out = OffRoad(z, s);
    if (out <= off_road_) return std::nullopt;
    return Violation(ConstraintKind::kRoad, 0, StepAt(from.time), out);
  };
  if (from.speed <= kStands) return std::nullopt;
  for (bool first = true; from.speed > kStands; first = false) {
    const double curvature = path.At(from.distance).curvature;
    const double across = std::abs(from.speed * from.speed * curvature - a_y_);
    if (across > grip + kGripTolerance && !first)
      return Violation(ConstraintKind::kFriction, 0, StepAt(from.time), across - grip);
    const double wanted = -Brakes(from.speed, curvature, deceleration);
    if (from.time >= begin + kResponse - 1e-9)
      from.acceleration = std::max(wanted, from.acceleration - settings_.jerk * kStep);
    const double next = std::max(from.speed + kStep * from.acceleration, 0.0);
    from.distance += 0.5 * (from.speed + next) * kStep;
    from.speed = next;
    from.time += kStep;
    if (const auto violation = clear(from.distance)) return violation;
  }
  return clear(from.distance + reserve);
}

}  // namespace control
