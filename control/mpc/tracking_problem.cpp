#include "control/mpc/tracking_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/qp/problem.hpp"
#include "control/road/keep_out.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {

namespace {

using Eigen::Vector2d;

constexpr double kLeastStretch = 0.1;  // beyond the centre of a bend
constexpr double kOverLimit = 0.3;     // [m/s]
constexpr double kStandstill = 0.15;   // speed that noise alone may show [m/s]
constexpr double kSlowDown = 1.0;      // deceleration of a vehicle that is too fast, at least [m/s²]

TrafficSettings TrafficSettingsOf(const VehicleParameters& vehicle, const LpvAffineSettings& settings) {
  TrafficSettings traffic{.footprint = settings.footprint,
                          .obstacle_margin = settings.obstacle_margin,
                          .road_margin = settings.road_margin,
                          .stop_gap = settings.stop_gap,
                          .t_s = settings.t_s,
                          .grip = Grip(settings),
                          .path = {}};
  const double wheelbase = vehicle.l_f + vehicle.l_r;
  traffic.path.max_curvature = std::tan(settings.u_max[kDelta]) / wheelbase;
  traffic.curvature_rate = settings.rate_max[kDelta] / settings.t_s / wheelbase;
  return traffic;
}

// Distance of the nearest corner from the half-space's edge, negative outside the half-space [m]; `arms`: from the vehicle's
// centre to its corners, in the map.
double Clearance(const HalfSpace& outside, const State& z, const std::array<Vector2d, 4>& arms) {
  const Vector2d normal(outside.a, outside.b);
  double least = std::numeric_limits<double>::infinity();
  for (const Vector2d& arm : arms) {
    least = std::min(least, normal.dot(Position(z) + arm) - outside.c);
  }
  return least;
}

// True if it passes one that moves ahead: slower, it would be beside it for longer.
bool Overtakes(const Manoeuvre& manoeuvre) {
  for (std::size_t k = 0; k < manoeuvre.objects.size(); ++k) {
    if (manoeuvre.side[k] != Side::kNone && manoeuvre.objects[k].MovesAhead()) return true;
  }
  return false;
}

}  // namespace

TrackingProblem::TrackingProblem(const VehicleParameters& vehicle, const RoadProfile& profile,
                                 const LpvAffineSettings& settings)
    : settings_(settings),
      grip_(Grip(settings)),
      profile_(&profile),
      progress_(vehicle, profile, settings.t_s, grip_),
      traffic_(TrafficSettingsOf(vehicle, settings), profile) {
  const auto N = static_cast<std::size_t>(settings.horizon);
  z_ref_.assign(N + 1, State::Zero());
  u_ref_.assign(N, Input::Zero());
  s_ref_.assign(N + 1, 0.0);
  rows_.resize(N + 1);
  counts_.assign(N + 1, 0);
}

void TrackingProblem::SetFrictionLimit(double mu_limit) {
  grip_ = Grip(settings_, mu_limit);
  progress_.SetGrip(grip_);
  traffic_.SetGrip(grip_);
}

void TrackingProblem::Reset() {
  waiting_ = rolled_ = false;
  traffic_.Reset();
}

void TrackingProblem::Begin(const State& z, double s, std::span<const Obstacle> obstacles,
                            const Disturbance& disturbance, bool slow_down) {
  constexpr double kLeastDistance = 0.3;  // [m]
  obstacles_ = obstacles;
  slope_ = disturbance.a_x;
  Place(z, s);
  manoeuvre_ = &traffic_.Plan(obstacles, place_);
  first_stop_ = RoadObjects::kMost;
  double first_s = profile_->length();
  for (std::size_t k = 0; k < manoeuvre_->stop_count; ++k) {
    if (manoeuvre_->stop_lines[k].s >= first_s) continue;
    first_s = manoeuvre_->stop_lines[k].s;
    first_stop_ = manoeuvre_->stop_objects[k];
  }
  progress_.Fill(place_.s, z_[kUpsilon], *manoeuvre_, z_ref_, u_ref_, s_ref_, disturbance,
                 slow_down && !Overtakes(*manoeuvre_));
  const bool nowhere_to_go =
      s_ref_.back() - s_ref_.front() < kLeastDistance && first_s - place_.s < kLeastDistance;
  rolled_ = waiting_ && (rolled_ || std::abs(z_[kUpsilon]) > kStandstill);
  waiting_ = nowhere_to_go && z_[kUpsilon] < (waiting_ ? 2.0 : 1.0) * kStandstill;
}

ManoeuvreStatus TrackingProblem::manoeuvre_status() const {
  ManoeuvreStatus status{.decision = manoeuvre_->decision,
                         .reason = manoeuvre_->reason,
                         .object = manoeuvre_->object,
                         .side = manoeuvre_->passed,
                         .left_out = manoeuvre_->left_out,
                         .speed_limit = LimitAt(place_.s)};
  for (const StopLine& line : manoeuvre_->stops()) {
    status.stop_distance = std::min(status.stop_distance, line.s - place_.s);
  }
  return status;
}

// The highest speed that road and manoeuvre allow at arc length s [m/s].
double TrackingProblem::LimitAt(double s) const {
  return std::min(profile_->SpeedWithin(grip_, s), manoeuvre_->SpeedLimitAt(s));
}

double TrackingProblem::SpeedLimit(std::size_t i) const {
  const double s = s_ref_[i];
  const double limit = LimitAt(s);
  const double slowed = place_.speed - kSlowDown * static_cast<double>(i) * settings_.t_s;
  return std::min(settings_.upsilon_max, std::max(limit, slowed) + kOverLimit);
}

void TrackingProblem::Hold(const Input& u_previous, std::span<State> z, std::span<Input> u) const {
  constexpr double kBrake = 1.0, kRolled = 3.0;  // beyond what the slope needs [m/s²]
  const double brake = std::abs(slope_) + (rolled_ ? kRolled : kBrake);
  State still = z_;
  still[kUpsilon] = still[kNu] = still[kOmega] = 0.0;
  std::ranges::fill(z, still);
  Input last = u_previous;
  for (Input& planned : u) {
    const double step = settings_.rate_max[kAcceleration];
    last[kAcceleration] += std::clamp(-brake - last[kAcceleration], -step, step);
    planned = last;
  }
}

void TrackingProblem::Place(const State& z, double s) {
  constexpr double kSteepest = 1.0;    // slope of the vehicle's way
  constexpr double kLeastSpeed = 2.0;  // below it, the vehicle moves along its axis [m/s]
  const RouteProjection place = profile_->Project(Position(z), s);
  const double psi = profile_->At(place.s).psi;
  z_ = z;
  z_[kPsi] = UnwrapAngle(z[kPsi], psi);
  const double sideslip = z_[kUpsilon] > kLeastSpeed ? z_[kNu] / z_[kUpsilon] : 0.0;
  place_ = {.s = place.s,
            .lateral = place.lateral,
            .slope = std::clamp(z_[kPsi] + sideslip - psi, -kSteepest, kSteepest),
            .speed = z_[kUpsilon]};
}

void TrackingProblem::BuildConstraints(std::span<const State> z_hat) {
  double s = place_.s;
  for (std::size_t i = 1; i < z_hat.size(); ++i) {
    const RouteProjection place = profile_->Project(Position(z_hat[i]), s);
    s = place.s;
    counts_[i] = 0;
    AddRoad(i, z_hat[i], place);
    AddObstacles(i, z_hat[i]);
  }
}

void TrackingProblem::Add(std::size_t i, const BodyRow& row) {
  rows_[i][counts_[i]++] = row;
}

// Adds rows for the middles of the front and the rear end; the corners are half a width beside them. The width of the
// road is that beside each end.
void TrackingProblem::AddRoad(std::size_t i, const State& z_hat, const RouteProjection& place) {
  const RoutePoint beside = profile_->At(place.s);
  const Vector2d left = LeftOf(beside.psi), point(beside.X, beside.Y);
  const double inside =
      settings_.footprint.half_width + manoeuvre_->RoadMarginAt(place.s, settings_.road_margin);
  // On a bend, the arc length to an end differs from the distance ahead along the tangent.
  const double stretch = std::max(1.0 - beside.curvature * place.lateral, kLeastStretch);
  for (const int end : {0, 1}) {
    const Vector2d fixed(end == 0 ? settings_.footprint.front : -settings_.footprint.rear, 0.0);
    // The road bends away from its tangent.
    const double ahead = Along(beside.psi).dot(Position(z_hat) + Rotate(z_hat[kPsi], fixed) - point);
    const double middle = left.dot(point) + 0.5 * beside.curvature * ahead * ahead;
    const RoadBounds road = profile_->RoadAt(place.s + ahead / stretch);
    Add(i, {.normal = left,
            .fixed = fixed,
            .lo = middle + road.right + inside,
            .hi = middle + road.left - inside,
            .constraint = {.kind = ConstraintKind::kRoad, .index = end, .step = static_cast<int>(i)}});
  }
}

// Adds rows for the objects whose half-spaces the predicted vehicle is nearest to.
void TrackingProblem::AddObstacles(std::size_t i, const State& z_hat) {
  struct Near {
    double clearance = 0.0;
    HalfSpace outside;
    int id = 0;
  };
  const std::array<Vector2d, 4> corners = settings_.footprint.Corners();
  const Eigen::Matrix2d to_map = Eigen::Rotation2Dd(z_hat[kPsi]).toRotationMatrix();
  std::array<Vector2d, 4> arms;
  std::ranges::transform(corners, arms.begin(),
                         [&](const Vector2d& corner) -> Vector2d { return to_map * corner; });
  std::array<Near, kMostObstacles + 1> nearest;
  std::size_t count = 0;
  for (std::size_t k = 0; k < manoeuvre_->objects.size(); ++k) {
    const auto outside = Outside(k, i, z_hat);
    if (!outside) continue;
    const Near object{.clearance = Clearance(*outside, z_hat, arms),
                      .outside = *outside,
                      .id = obstacles_[manoeuvre_->objects[k].index].id};
    const auto end = nearest.begin() + static_cast<std::ptrdiff_t>(count);
    const auto place = std::ranges::upper_bound(nearest.begin(), end, object.clearance, {}, &Near::clearance);
    std::move_backward(place, end, end + 1);
    *place = object;
    count = std::min(count + 1, kMostObstacles);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const HalfSpace& outside = nearest[k].outside;
    const Vector2d normal(outside.a, outside.b);
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    std::ranges::sort(order, {}, [&](std::size_t corner) { return normal.dot(arms[corner]); });
    for (const std::size_t corner : {order[0], order[1]}) {
      Add(i, {.normal = normal,
              .fixed = corners[corner],
              .lo = outside.c,
              .hi = kNoBound,
              .constraint = {
                  .kind = ConstraintKind::kObstacle, .index = nearest[k].id, .step = static_cast<int>(i)}});
    }
  }
}

std::optional<HalfSpace> TrackingProblem::Outside(std::size_t k, std::size_t i, const State& z_hat) const {
  const Side passed = manoeuvre_->side[k];
  if (passed == Side::kNone && k != first_stop_) return std::nullopt;
  const RoadObject& object = manoeuvre_->objects[k];
  const double margin = manoeuvre_->margin[k];
  double time = static_cast<double>(i) * settings_.t_s;
  const bool goes_away = passed == Side::kLeft ? object.drift < 0.0 : object.drift > 0.0;
  if (goes_away) time = object.Since(time);
  const Obstacle obstacle = Predict(obstacles_[object.index], object, *profile_, time);
  const Vector2d t = object.speed == 0.0 ? object.along : Along(profile_->At(object.SAt(time)).psi);
  if (k == first_stop_) return HalfSpaceBefore(obstacle, t, margin);
  const PassingSide side = passed == Side::kLeft ? PassingSide::kLeft : PassingSide::kRight;
  const double reach = 0.5 * settings_.t_s * z_hat[kUpsilon] + margin;
  return PassingHalfSpace(obstacle, side, z_hat, t, settings_.footprint, margin, reach);
}

}  // namespace control
