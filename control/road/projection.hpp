// The nearest-point search along a sampled path, and points beside a route.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ranges>
#include <span>

#include "control/road/route.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/types.hpp"

namespace control {

// The local minimum of `distance` searched from sample `from`, first forwards, then backwards, within first..last.
// `distance(k)` is any measure that increases with the distance to sample k.
template <typename Distance>
[[nodiscard]] int NearestSample(const Distance& distance, int from, int first, int last) {
  int k = from;
  while (k < last && distance(k + 1) < distance(k)) ++k;
  while (k > first && distance(k - 1) < distance(k)) --k;
  return k;
}

// The first sample with the least `distance` of first..last, all of which are compared.
template <typename Distance>
[[nodiscard]] int NearestOfAll(const Distance& distance, int first, int last) {
  return *std::ranges::min_element(std::views::iota(first, last + 1), {}, distance);
}

// A position relative to a point of a path [m].
struct PathOffset {
  double ahead = 0.0;
  double left = 0.0;
};

// `along`: unit vector along the path at `point`.
[[nodiscard]] inline PathOffset OffsetFrom(const Eigen::Vector2d& point, const Eigen::Vector2d& along,
                                           const Eigen::Vector2d& position) {
  const Eigen::Vector2d d = position - point;
  return {.ahead = along.dot(d), .left = along.x() * d.y() - along.y() * d.x()};
}

// `psi`: heading of the path at `point` [rad].
[[nodiscard]] inline PathOffset OffsetFrom(const Eigen::Vector2d& point, double psi,
                                           const Eigen::Vector2d& position) {
  return OffsetFrom(point, Along(psi), position);
}

[[nodiscard]] inline Eigen::Vector2d Position(const RoutePoint& point) {
  return {point.X, point.Y};
}

// The point `lateral` [m] beside the route, left positive.
[[nodiscard]] inline Eigen::Vector2d Beside(const RoutePoint& point, double lateral) {
  return {point.X - lateral * std::sin(point.psi), point.Y + lateral * std::cos(point.psi)};
}

[[nodiscard]] inline Eigen::Vector2d Beside(const State& z, double lateral) {
  return Position(z) + lateral * LeftOf(z[kPsi]);
}

// The state of a sampled reference beside `position`, interpolated; on the straight extensions before its first and after
// its last sample. On the outside of a corner it is on the extension of the leg before the corner.
[[nodiscard]] inline State InterpolateBeside(const Eigen::Vector2d& position,
                                             std::span<const State> reference) {
  State beside = reference.front();
  for (std::size_t i = 0; i + 1 < reference.size(); ++i) {
    const Eigen::Vector2d from = Position(reference[i]);
    const Eigen::Vector2d way = Position(reference[i + 1]) - from;
    if (way.squaredNorm() < 1e-6) break;
    const double share = (position - from).dot(way) / way.squaredNorm();
    if (i > 0 && share < 0.0) break;
    beside = reference[i] + share * (reference[i + 1] - reference[i]);
    if (share <= 1.0) break;
  }
  return beside;
}

// The point `distance` [m] ahead on the straight extension of the route at `point`.
[[nodiscard]] inline RoutePoint StraightAhead(RoutePoint point, double distance) {
  point.X += distance * std::cos(point.psi);
  point.Y += distance * std::sin(point.psi);
  point.curvature = 0.0;
  return point;
}

}  // namespace control
