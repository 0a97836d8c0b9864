#include "control/road/stop_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/steady_cornering.hpp"

namespace control {
namespace {

constexpr double kSpacing = 0.25;       // least distance between two knots along a plan [m]
constexpr double kLeastStep = 0.5;      // the same beyond it
constexpr double kLeastSpacing = 1e-3;  // taken for knots that coincide inside a bend [m]
constexpr double kLateral = 2.0;        // lateral acceleration beyond the plan's end [m/s²]
constexpr double kSharpest = 4.0;       // the same where the road's edge is near
constexpr double kLeastDecay = 2.0;     // ℓ at least [m]
constexpr double kDecayTime = 0.6;      // ℓ per speed, at least [s]
constexpr double kSteepest = 1.0;       // |d'|
constexpr double kLeastStretch = 0.2;   // beyond the centre of a bend
constexpr double kDeceleration = 1.5;   // of a stop that ends before the last knot [m/s²]
constexpr double kLeastLength = 20.0;   // of the path beyond the plan [m]

double DirectionOf(const State& z) {
  return z[kPsi] + (z[kUpsilon] > kMinSteeringSpeed ? std::atan2(z[kNu], z[kUpsilon]) : 0.0);
}

}  // namespace

StopPath::StopPath(const VehicleParameters& vehicle, const RoadProfile& profile, int horizon,
                   double half_width)
    : vehicle_(vehicle), profile_(&profile), half_width_(half_width) {
  knots_.reserve(Index(horizon) + 1 + kBeyond);
  knots_.emplace_back();
}

void StopPath::Follow(std::span<const State> plan, double s, const LateralPath& beyond) {
  constexpr std::size_t kTail = 5;  // last steps of a plan, in which nothing holds it to its way
  plan = plan.first(plan.size() - std::min(plan.size() / 4, kTail));
  FollowPlan(plan, s);
  const double upsilon = plan.back()[kUpsilon];
  const Transition transition = TransitionTo(beyond, upsilon);
  const double length = 0.5 * upsilon * upsilon / kDeceleration + kLeastLength;
  const double step = std::max(length / static_cast<double>(kBeyond), kLeastStep);
  for (std::size_t k = 1; k <= kBeyond; ++k) {
    const double at = transition.s + static_cast<double>(k) * step;
    Add(PointBeside(at, transition.At(at, beyond)));
  }
}

StopPathPoint StopPath::PointBeside(double s, const LateralPoint& path) const {
  const RoutePoint road = profile_->At(s);
  const double stretch = std::max(1.0 - road.curvature * path.offset, kLeastStretch);
  return {.p = Beside(road, path.offset),
          .direction = road.psi + std::atan(path.slope / stretch),
          .curvature = road.curvature / stretch,
          .s = s};
}

void StopPath::FollowPlan(std::span<const State> plan, double s) {
  knots_.clear();
  for (const State& z : plan) {
    if (!knots_.empty() && (Position(z) - knots_.back().point.p).norm() < kSpacing) continue;
    s = profile_->Project(Position(z), s).s;
    Add({.p = Position(z), .direction = DirectionOf(z), .s = s});
  }
}

void StopPath::Add(const StopPathPoint& point) {
  Knot knot{.point = point};
  if (!knots_.empty()) {
    Knot& last = knots_.back();
    const double far = std::max((point.p - last.point.p).norm(), kLeastSpacing);
    knot.distance = last.distance + far;
    last.point.curvature = WrapAngle(point.direction - last.point.direction) / far;
    knot.point.curvature = last.point.curvature;
  }
  knots_.push_back(knot);
}

// d, d' at s
LateralPoint StopPath::Transition::At(double at, const LateralPath& beyond) const {
  const double x = at - s, left = std::exp(-x / decay), rate = slope + offset / decay;
  const LateralPoint path = beyond.exists ? beyond.At(at) : LateralPoint{.offset = parallel};
  return {.offset = path.offset + (offset + rate * x) * left,
          .slope = path.slope + (rate - (offset + rate * x) / decay) * left};
}

StopPath::Transition StopPath::TransitionTo(const LateralPath& beyond, double upsilon) const {
  const StopPathPoint& end = knots_.back().point;
  const RoutePoint road = profile_->At(end.s);
  const double d = OffsetFrom({road.X, road.Y}, road.psi, end.p).left;
  const double direction = std::clamp(WrapAngle(end.direction - road.psi), -1.0, 1.0);
  const double slope = std::clamp(std::tan(direction), -kSteepest, kSteepest);
  // Without a path beside the road, e_end is the way that the decay of the slope takes, so that ℓ depends on the slope alone.
  const LateralPoint path = beyond.At(end.s);
  const double e = beyond.exists ? d - path.offset : 0.0, e_slope = slope - path.slope;
  Transition transition{.s = end.s, .slope = e_slope};
  for (const double lateral : {kLateral, kSharpest}) {
    const double curvature = lateral / std::max(upsilon * upsilon, kLeastDecay);
    const double sharp = beyond.exists
                             ? std::abs(e_slope) + std::sqrt(e_slope * e_slope + curvature * std::abs(e))
                             : std::abs(e_slope);  // with ℓ = sharp/curvature, e'' begins with that curvature
    transition.decay = std::max({sharp / curvature, kDecayTime * upsilon, kLeastDecay});
    transition.offset = beyond.exists ? e : -e_slope * transition.decay;
    transition.parallel = d - transition.offset;
    if (!LeavesRoad(transition, beyond)) break;
  }
  return transition;
}

bool StopPath::LeavesRoad(const Transition& transition, const LateralPath& beyond) const {
  constexpr int kPlaces = 8;  // at which that is seen, ℓ/2 apart
  for (int k = 1; k <= kPlaces; ++k) {
    const double s = transition.s + 0.5 * k * transition.decay;
    const double offset = transition.At(s, beyond).offset;
    const RoadBounds edges = profile_->RoadAt(s);
    if (offset > edges.left - half_width_ || offset < edges.right + half_width_) return true;
  }
  return false;
}

StopPathPoint StopPath::At(double distance) const {
  const auto after = std::ranges::upper_bound(knots_, distance, {}, &Knot::distance);
  const Knot& from = after == knots_.begin() ? knots_.front() : *(after - 1);
  const double x = distance - from.distance;
  if (after == knots_.begin()) {
    StopPathPoint before = from.point;
    before.p += x * Along(before.direction);
    before.s += x;
    return before;
  }
  if (after == knots_.end()) {  // only a vehicle that can hardly brake gets there
    const RoutePoint road = profile_->At(from.point.s);
    const double d = OffsetFrom({road.X, road.Y}, road.psi, from.point.p).left;
    const double stretch = std::max(1.0 - road.curvature * d, kLeastStretch);
    return PointBeside(from.point.s + x / stretch, {.offset = d});
  }
  const double share = x / (after->distance - from.distance);
  return {.p = from.point.p + share * (after->point.p - from.point.p),
          .direction = from.point.direction + x * from.point.curvature,
          .curvature = from.point.curvature,
          .s = std::lerp(from.point.s, after->point.s, share)};
}

double StopPath::DistanceOf(const Eigen::Vector2d& position, double s) const {
  constexpr double kNear = 20.0;  // difference of s up to which the path counts; it may cross itself [m]
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < knots_.size(); ++k) {
    if (std::abs(knots_[k].point.s - s) > kNear) continue;
    const Eigen::Vector2d from = knots_[k].point.p, way = knots_[k + 1].point.p - from;
    const double share = std::clamp((position - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const double far = (position - from - share * way).squaredNorm();
    if (far >= least) continue;
    least = far;
    best = std::lerp(knots_[k].distance, knots_[k + 1].distance, share);
  }
  return best;
}

double StopPath::Steering(const RouteMotion& motion, double s) const {
  constexpr double kTime = 0.6, kShortest = 3.0;  // ℓ_s = max(kTime υ, kShortest) [s, m]
  constexpr double kMost = 0.3;                   // change of direction that is aimed at [rad]
  const double length = std::max(kTime * motion.speed, kShortest);
  constexpr double kPreview = 0.1;  // by which the steering precedes the bend [s]
  const double distance = DistanceOf(motion.p, s);
  const StopPathPoint path = At(distance);
  const double e = LeftOf(path.direction).dot(motion.p - path.p);
  const double turn = WrapAngle(motion.travel_direction - path.direction);
  const double back = std::clamp(e / length, -kMost, kMost);
  const double ahead = At(distance + kPreview * motion.speed).curvature;
  const double curvature = ahead - (2.0 * turn + back) / length;
  return curvature * SteeringPerCurvature(vehicle_, motion.speed);
}

}  // namespace control
