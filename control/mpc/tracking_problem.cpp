#include "control/mpc/tracking_problem.hpp"

#include <algorithm>
#include <cmath>

#include "control/qp/problem.hpp"
#include "control/road/keep_out.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {

using Eigen::Vector2d;

TrackingProblem::TrackingProblem(const VehicleParameters& vehicle, const RoadProfile& profile,
                                 const LpvAffineSettings& settings)
    : settings_(settings),
      profile_(&profile),
      progress_(vehicle, profile, settings.t_s),
      passing_({.footprint = settings.footprint,
                .margin = settings.obstacle_margin,
                .road_margin = settings.road_margin,
                .grip = Grip(settings)},
               profile) {
  const auto N = static_cast<std::size_t>(settings.horizon);
  z_ref_.assign(N + 1, State::Zero());
  u_ref_.assign(N, Input::Zero());
  s_ref_.assign(N + 1, 0.0);
  rows_.resize(N + 1);
  counts_.assign(N + 1, 0);
  stops_.reserve(PassingPlanner::kMostObstacles);
}

void TrackingProblem::Reset() {
  waiting_ = false;
  passing_.Reset();
}

void TrackingProblem::Begin(const State& z, double s, std::span<const Obstacle> obstacles) {
  constexpr double kStandstill = 0.15;    // [m/s]
  constexpr double kLeastDistance = 0.3;  // [m]
  obstacles_ = obstacles;
  Place(z, s);
  DecidePassing();
  progress_.Fill(s_, z_[kUpsilon], stops_, z_ref_, u_ref_, s_ref_);
  const bool nowhere_to_go = s_ref_.back() - s_ref_.front() < kLeastDistance;
  waiting_ = nowhere_to_go && z_[kUpsilon] < (waiting_ ? 2.0 : 1.0) * kStandstill;
}

void TrackingProblem::Hold(const Input& u_previous, std::span<State> z, std::span<Input> u) const {
  constexpr double kBrake = -1.0;  // [m/s²]
  State still = z_;
  still[kUpsilon] = still[kNu] = still[kOmega] = 0.0;
  std::ranges::fill(z, still);
  Input last = u_previous;
  for (Input& planned : u) {
    const double step = settings_.rate_max[kAcceleration];
    last[kAcceleration] += std::clamp(kBrake - last[kAcceleration], -step, step);
    planned = last;
  }
}

void TrackingProblem::Place(const State& z, double s) {
  const RouteProjection place = profile_->Project(Position(z), s);
  s_ = place.s;
  lateral_ = place.lateral;
  z_ = z;
  z_[kPsi] = UnwrapAngle(z[kPsi], profile_->At(s_).psi);
}

void TrackingProblem::DecidePassing() {
  decisions_ = passing_.Decide(obstacles_, s_, lateral_, z_[kUpsilon]);
  stops_.clear();
  first_stop_.reset();
  double first_s = 0.0;
  for (std::size_t k = 0; k < decisions_.size(); ++k) {
    const PassingDecision& decision = decisions_[k];
    if (decision.passage != Passage::kStop) continue;
    const double before = decision.half_length + settings_.footprint.front + settings_.stop_gap;
    stops_.push_back({.s = decision.s - before, .speed = std::max(decision.speed, 0.0)});
    if (!first_stop_ || stops_.back().s < first_s) {
      first_stop_ = k;
      first_s = stops_.back().s;
    }
  }
}

bool TrackingProblem::BuildConstraints(std::span<const State> z_hat) {
  bool fits = obstacles_.size() <= PassingPlanner::kMostObstacles;
  double s = s_;
  for (std::size_t i = 1; i < z_hat.size(); ++i) {
    s = profile_->Project(Position(z_hat[i]), s).s;
    const RoutePoint beside = profile_->At(s);
    counts_[i] = 0;
    fits &= AddRoad(i, z_hat[i], beside);
    fits &= AddObstacles(i, z_hat[i], beside.psi);
  }
  return fits;
}

bool TrackingProblem::Add(std::size_t i, const BodyRow& row) {
  if (counts_[i] == kMostRows) return false;
  rows_[i][counts_[i]++] = row;
  return true;
}

// Adds rows for the middles of the front and the rear end; the corners are half a width beside them.
bool TrackingProblem::AddRoad(std::size_t i, const State& z_hat, const RoutePoint& beside) {
  const Vector2d left = LeftOf(beside.psi), point(beside.X, beside.Y);
  const double inside = settings_.footprint.half_width + settings_.road_margin;
  bool fits = true;
  for (const int end : {0, 1}) {
    const Vector2d fixed(end == 0 ? settings_.footprint.front : -settings_.footprint.rear, 0.0);
    // The road bends away from its tangent.
    const double ahead = Along(beside.psi).dot(Position(z_hat) + Rotate(z_hat[kPsi], fixed) - point);
    const double middle = left.dot(point) + 0.5 * beside.curvature * ahead * ahead;
    fits &=
        Add(i, {.normal = left,
                .fixed = fixed,
                .lo = middle + profile_->road().right + inside,
                .hi = middle + profile_->road().left - inside,
                .constraint = {.kind = ConstraintKind::kRoad, .index = end, .step = static_cast<int>(i)}});
  }
  return fits;
}

bool TrackingProblem::AddObstacles(std::size_t i, const State& z_hat, double psi_road) {
  bool fits = true;
  for (std::size_t k = 0; k < decisions_.size(); ++k) {
    const Passage passage = decisions_[k].passage;
    if (passage == Passage::kIgnored || (passage == Passage::kStop && k != first_stop_)) continue;
    const Obstacle obstacle = Predict(obstacles_[k], static_cast<double>(i) * settings_.t_s);
    const auto outside = Outside(obstacle, passage, z_hat, psi_road);
    if (!outside) continue;
    const Vector2d normal(outside->a, outside->b);
    std::array<Vector2d, 4> corners = settings_.footprint.Corners();
    std::ranges::sort(corners, {},
                      [&](const Vector2d& corner) { return normal.dot(Rotate(z_hat[kPsi], corner)); });
    for (const std::size_t nearest : {0U, 1U}) {
      fits &=
          Add(i, {.normal = normal,
                  .fixed = corners[nearest],
                  .lo = outside->c,
                  .hi = kNoBound,
                  .constraint = {
                      .kind = ConstraintKind::kObstacle, .index = obstacle.id, .step = static_cast<int>(i)}});
    }
  }
  return fits;
}

std::optional<HalfSpace> TrackingProblem::Outside(const Obstacle& obstacle, Passage passage,
                                                  const State& z_hat, double psi_road) const {
  const double margin = settings_.obstacle_margin;
  if (passage == Passage::kStop) return HalfSpaceBefore(obstacle, psi_road, margin);
  const PassingSide side = passage == Passage::kLeft ? PassingSide::kLeft : PassingSide::kRight;
  const double reach = 0.5 * settings_.t_s * z_hat[kUpsilon] + margin;
  return PassingHalfSpace(obstacle, side, z_hat, psi_road, settings_.footprint, margin, reach);
}

}  // namespace control
