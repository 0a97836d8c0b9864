#include "loop/route_place.hpp"

#include <cmath>

namespace loop {
namespace {

Eigen::Vector2d Position(const control::State& z) {
  return {z[control::kX], z[control::kY]};
}

}  // namespace

std::optional<int> FindOnRoute(const control::TimeReference& reference, const control::RoadBounds& road,
                               const control::State& z, double max_heading_error) {
  const int last = reference.size() - 1;
  const Eigen::Vector2d p = Position(z);
  const auto distance = [&](int k) { return (p - Position(reference[k])).squaredNorm(); };
  for (int k = 0; k <= last; ++k) {
    const double here = distance(k);
    if ((k > 0 && distance(k - 1) <= here) || (k < last && distance(k + 1) < here)) {
      continue;
    }
    const control::State& r = reference[k];
    const Eigen::Vector2d d = p - Position(r);
    const Eigen::Vector2d along(std::cos(r[control::kPsi]), std::sin(r[control::kPsi]));
    const double ahead = along.dot(d);
    const double left = along.x() * d.y() - along.y() * d.x();
    const int neighbour = k < last ? k + 1 : k - 1;
    const double spacing = (Position(reference[neighbour]) - Position(r)).norm();
    if (std::abs(ahead) <= spacing && left <= road.left && left >= road.right &&
        std::abs(control::WrapAngle(z[control::kPsi] - r[control::kPsi])) <= max_heading_error) {
      return k;
    }
  }
  return std::nullopt;
}

}  // namespace loop
