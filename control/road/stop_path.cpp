#include "control/road/stop_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/steady_cornering.hpp"

namespace control {
namespace {

constexpr double kSpacing = 0.25;      // least distance between two knots [m]
constexpr double kLateral = 2.0;       // lateral acceleration beyond the plan's end [m/s²]
constexpr double kSharpest = 4.0;      // the same where the road's edge is near
constexpr double kLeastDecay = 2.0;    // ℓ at least [m]
constexpr double kDecayTime = 0.6;     // ℓ per speed, at least [s]
constexpr double kSteepest = 1.0;      // |d'|
constexpr double kLeastStretch = 0.2;  // beyond the centre of a bend

double DirectionOf(const State& z) {
  return z[kPsi] + (z[kUpsilon] > kMinSteeringSpeed ? std::atan2(z[kNu], z[kUpsilon]) : 0.0);
}

}  // namespace

StopPath::StopPath(const VehicleParameters& vehicle, const RoadProfile& profile, int horizon,
                   double half_width)
    : vehicle_(vehicle), profile_(&profile), half_width_(half_width) {
  knots_.reserve(Index(horizon) + 1);
  knots_.emplace_back();
}

void StopPath::Follow(std::span<const State> plan, double s) {
  constexpr std::size_t kTail = 5;  // last steps of a plan, in which nothing holds it to its way
  plan = plan.first(plan.size() - std::min(plan.size() / 4, kTail));
  knots_.clear();
  for (std::size_t i = 0; i < plan.size() && knots_.size() < knots_.capacity(); ++i) {
    const State& z = plan[i];
    const double far = knots_.empty() ? 0.0 : (Position(z) - knots_.back().point.p).norm();
    if (!knots_.empty() && far < kSpacing) continue;
    const RouteProjection place = profile_->Project(Position(z), knots_.empty() ? s : knots_.back().point.s);
    Knot knot{.point = {.p = Position(z), .direction = DirectionOf(z), .s = place.s}};
    if (!knots_.empty()) {
      Knot& last = knots_.back();
      knot.distance = last.distance + far;
      last.point.curvature = WrapAngle(knot.point.direction - last.point.direction) / far;
      knot.point.curvature = last.point.curvature;
    }
    knots_.push_back(knot);
  }
  const StopPathPoint& end = knots_.back().point;
  const RoutePoint road = profile_->At(end.s);
  const double upsilon = plan.back()[kUpsilon];
  offset_ = OffsetFrom({road.X, road.Y}, road.psi, end.p).left;
  slope_ =
      std::clamp(std::tan(std::clamp(WrapAngle(end.direction - road.psi), -1.0, 1.0)), -kSteepest, kSteepest);
  const RoadBounds edges = profile_->RoadAt(end.s);
  const double room = slope_ > 0.0 ? edges.left - half_width_ - offset_ : offset_ - half_width_ - edges.right;
  const double sharpest = upsilon * upsilon * std::abs(slope_) / kSharpest;
  decay_ = std::max(upsilon * upsilon * std::abs(slope_) / kLateral, kDecayTime * upsilon);
  if (decay_ * std::abs(slope_) > room) decay_ = std::max(room / std::abs(slope_), sharpest);
  decay_ = std::max(decay_, kLeastDecay);
}

StopPathPoint StopPath::At(double distance) const {
  const Knot& end = knots_.back();
  if (distance >= end.distance) return Beyond(distance - end.distance);
  const auto after = std::ranges::upper_bound(knots_, distance, {}, &Knot::distance);
  const Knot& from = after == knots_.begin() ? knots_.front() : *(after - 1);
  const double x = distance - from.distance;
  if (after == knots_.begin()) {
    StopPathPoint before = from.point;
    before.p += x * Along(before.direction);
    before.s += x;
    return before;
  }
  const double share = x / (after->distance - from.distance);
  return {.p = from.point.p + share * (after->point.p - from.point.p),
          .direction = from.point.direction + x * from.point.curvature,
          .curvature = from.point.curvature,
          .s = std::lerp(from.point.s, after->point.s, share)};
}

StopPathPoint StopPath::Beyond(double x) const {
  const double left = std::exp(-x / decay_), slope = slope_ * left;
  const double d = offset_ + slope_ * decay_ * (1.0 - left);
  const StopPathPoint& end = knots_.back().point;
  const double stretch = std::max(1.0 - profile_->At(end.s).curvature * d, kLeastStretch);
  const double s = end.s + x / (stretch * std::hypot(1.0, slope));
  const RoutePoint road = profile_->At(s);
  const double here = std::max(1.0 - road.curvature * d, kLeastStretch);
  return {.p = Beside(road, d),
          .direction = road.psi + std::atan(slope),
          .curvature = road.curvature / here - slope / decay_,
          .s = s};
}

double StopPath::DistanceOf(const Eigen::Vector2d& position) const {
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < knots_.size(); ++k) {
    const Eigen::Vector2d from = knots_[k].point.p, way = knots_[k + 1].point.p - from;
    const double share = std::clamp((position - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const double far = (position - from - share * way).squaredNorm();
    if (far >= least) continue;
    least = far;
    best = std::lerp(knots_[k].distance, knots_[k + 1].distance, share);
  }
  const StopPathPoint& end = knots_.back().point;
  const double past = Along(end.direction).dot(position - end.p);
  if (past > 0.0 && best >= knots_.back().distance) {
    const double s = profile_->Project(position, end.s + past).s;
    best += std::max(s - end.s, 0.0);
  }
  return best;
}

double StopPath::Steering(const RouteMotion& motion) const {
  constexpr double kTime = 0.6, kShortest = 3.0;  // ℓ_s = max(kTime υ, kShortest) [s, m]
  constexpr double kMost = 0.3;                   // change of direction that is aimed at [rad]
  const double length = std::max(kTime * motion.speed, kShortest);
  constexpr double kPreview = 0.1;  // by which the steering precedes the bend [s]
  const double distance = DistanceOf(motion.p);
  const StopPathPoint path = At(distance);
  const double e = LeftOf(path.direction).dot(motion.p - path.p);
  const double turn = WrapAngle(motion.travel_direction - path.direction);
  const double back = std::clamp(e / length, -kMost, kMost);
  const double ahead = At(distance + kPreview * motion.speed).curvature;
  const double curvature = ahead - (2.0 * turn + back) / length;
  return curvature * SteeringPerCurvature(vehicle_, motion.speed);
}

}  // namespace control
