#include "control/road/road_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {
namespace {

Eigen::Vector2d Position(const RoutePoint& point) {
  return {point.X, point.Y};
}

RoutePoint Ahead(RoutePoint point, double distance) {
  point.X += distance * std::cos(point.psi);
  point.Y += distance * std::sin(point.psi);
  return point;
}

double Mix(double from, double to, double share) {
  return from + share * (to - from);
}

}  // namespace

double StoppingSpeed(double distance, double deceleration) {
  return distance > RoadProfile::kStopWithin ? std::sqrt(2.0 * deceleration * distance) : 0.0;
}

RoadProfile::RoadProfile(const Route& route, const RoadBounds& road, const SpeedLimits& limits)
    : length_(route.length()), road_(road), limits_(limits) {
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
    RoutePoint before = Ahead(points_.front(), s);
    before.curvature = 0.0;
    return before;
  }
  if (s >= length_) {
    RoutePoint after = Ahead(points_.back(), s - length_);
    after.curvature = 0.0;
    return after;
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
  const auto distance = [&](std::size_t k) { return (position - Position(points_[k])).squaredNorm(); };
  const double last = static_cast<double>(points_.size() - 1);
  auto k = static_cast<std::size_t>(std::clamp(std::round(hint / spacing_), 0.0, last));
  while (k + 1 < points_.size() && distance(k + 1) < distance(k)) ++k;
  while (k > 0 && distance(k - 1) < distance(k)) --k;
  const RoutePoint& point = points_[k];
  const Eigen::Vector2d d = position - Position(point);
  const Eigen::Vector2d along(std::cos(point.psi), std::sin(point.psi));
  const double left = along.x() * d.y() - along.y() * d.x();
  // On a curve, ahead of the sample, the course advances by less or more than the position does.
  const bool inside = k > 0 && k + 1 < points_.size();
  const double stretch = inside ? std::max(1.0 - point.curvature * left, 0.1) : 1.0;
  const double s = static_cast<double>(k) * spacing_ + along.dot(d) / stretch;
  const RoutePoint foot = At(s);
  const Eigen::Vector2d from_foot = position - Position(foot);
  return {.s = s, .lateral = std::cos(foot.psi) * from_foot.y() - std::sin(foot.psi) * from_foot.x()};
}

RouteProjection RoadProfile::Find(const Eigen::Vector2d& position, double psi) const {
  constexpr double kAsGood = 1.0;  // [m]
  double least = std::numeric_limits<double>::infinity();
  const auto along = [&](const RoutePoint& point) { return std::cos(point.psi - psi) > 0.0; };
  for (const RoutePoint& point : points_) {
    if (along(point)) least = std::min(least, (position - Position(point)).norm());
  }
  const auto first = std::ranges::find_if(points_, [&](const RoutePoint& point) {
    return along(point) && (position - Position(point)).norm() < least + kAsGood;
  });
  const auto k = first == points_.end() ? 0 : first - points_.begin();
  return Project(position, static_cast<double>(k) * spacing_);
}

}  // namespace control
