#include "control/road/road_profile.hpp"

#include <algorithm>
#include <cmath>

#include "control/road/projection.hpp"

namespace control {
namespace {

double Mix(double from, double to, double share) {
  return from + share * (to - from);
}

}  // namespace

double StoppingSpeed(double distance, double deceleration) {
  return distance > RoadProfile::kStopWithin ? std::sqrt(2.0 * deceleration * distance) : 0.0;
}

RoadProfile::RoadProfile(const Route& route, const RoadEdges& edges, const SpeedLimits& limits)
    : length_(route.length()), edges_(edges), limits_(limits) {
  const auto steps = std::max<long>(1, std::lround(std::ceil(length_ / kSpacing)));
  spacing_ = length_ / static_cast<double>(steps);
  points_.reserve(static_cast<std::size_t>(steps) + 1);
  for (long k = 0; k <= steps; ++k) {
    RoutePoint point = route.At(static_cast<double>(k) * spacing_);
    const double curvature = std::max(std::abs(point.curvature), 1e-9);
    point.speed = std::min(point.speed, std::sqrt(limits.lateral / curvature));
    points_.push_back(point);
  }
  points_.back().speed = 0.0;
  for (std::size_t k = points_.size() - 1; k-- > 0;) {
    const double next = points_[k + 1].speed;
    points_[k].speed =
        std::min(points_[k].speed, std::sqrt(next * next + 2.0 * limits.deceleration * spacing_));
  }
}

RoutePoint RoadProfile::At(double s) const {
  if (s <= 0.0) {
    return StraightAhead(points_.front(), s);
  }
  if (s >= length_) {
    return StraightAhead(points_.back(), s - length_);
  }
  const double place = s / spacing_;
  const auto k = std::min(static_cast<std::size_t>(place), points_.size() - 2);
  const double share = place - static_cast<double>(k);
  const RoutePoint& from = points_[k];
  const RoutePoint& to = points_[k + 1];
  // v² is linear in s, so that the speed falls at the profile's deceleration down to 0.
  const double squared = Mix(from.speed * from.speed, to.speed * to.speed, share);
  return {.X = Mix(from.X, to.X, share),
          .Y = Mix(from.Y, to.Y, share),
          .psi = Mix(from.psi, to.psi, share),
          .curvature = Mix(from.curvature, to.curvature, share),
          .speed = std::sqrt(squared)};
}

RouteProjection RoadProfile::Project(const Eigen::Vector2d& position, double hint) const {
  const auto at = [&](int k) -> const RoutePoint& { return points_[static_cast<std::size_t>(k)]; };
  const auto distance = [&](int k) { return (position - Position(at(k))).squaredNorm(); };
  const int last = static_cast<int>(points_.size()) - 1;
  const auto from = static_cast<int>(std::clamp(std::round(hint / spacing_), 0.0, static_cast<double>(last)));
  const int k = NearestSample(distance, from, 0, last);
  const RoutePoint& point = at(k);
  const auto [ahead, left] = OffsetFrom(Position(point), point.psi, position);
  // On a curve, the arc length from the sample to the projection differs from the distance ahead along the tangent.
  const bool inside = k > 0 && k < last;
  const double stretch = inside ? std::max(1.0 - point.curvature * left, 0.1) : 1.0;
  const double s = static_cast<double>(k) * spacing_ + ahead / stretch;
  const RoutePoint foot = At(s);
  return {.s = s, .lateral = OffsetFrom(Position(foot), foot.psi, position).left};
}

}  // namespace control
