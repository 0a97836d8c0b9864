#include "loop/find_on_route.hpp"

#include <algorithm>
#include <cmath>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"

namespace loop {

std::optional<int> FindOnRoute(const control::TimeReference& reference, const control::RoadEdges& edges,
                               const control::State& z, double max_heading_error) {
  using control::Position;
  const int last = reference.size() - 1;
  const Eigen::Vector2d p = Position(z);
  const auto distance = [&](int k) { return (p - Position(reference[k])).squaredNorm(); };
  for (int k = 0; k <= last; ++k) {
    const bool nearer_than_before = k == 0 || distance(k) < distance(k - 1);
    if (!nearer_than_before || control::NearestSample(distance, k, k, std::min(k + 1, last)) != k) {
      continue;
    }
    const control::State& r = reference[k];
    const auto [ahead, left] = control::OffsetFrom(Position(r), r[control::kPsi], p);
    const int neighbour = k < last ? k + 1 : k - 1;
    const double spacing = (Position(reference[neighbour]) - Position(r)).norm();
    const control::RoadBounds road = edges.At(reference.ArcLength(k) + ahead);
    if (std::abs(ahead) <= spacing && left <= road.left && left >= road.right &&
        std::abs(control::WrapAngle(z[control::kPsi] - r[control::kPsi])) <= max_heading_error) {
      return k;
    }
  }
  return std::nullopt;
}

}  // namespace loop
