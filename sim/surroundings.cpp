#include "sim/surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "control/road/projection.hpp"

namespace sim {

Surroundings::Surroundings(const control::Route& route) : route_(route) {
  constexpr double kSpacing = 2.0;  // at most [m]
  const int intervals = std::max(1, static_cast<int>(std::ceil(route.length() / kSpacing)));
  spacing_ = route.length() / intervals;
  samples_.reserve(static_cast<std::size_t>(intervals) + 1);
  for (int i = 0; i <= intervals; ++i) samples_.push_back(control::Position(route.At(i * spacing_)));
}

std::optional<RoadBody> Surroundings::OnRoad(const control::Obstacle& object, double s) const {
  const Eigen::Vector2d position(object.X, object.Y);
  const int end = static_cast<int>(samples_.size()) - 1;
  const auto index = [&](double at) {
    return static_cast<int>(std::clamp(at / spacing_, 0.0, static_cast<double>(end)));
  };
  const int first = index(s - kBehind), last = index(s + kAhead);
  const auto distance = [&](int k) {
    return (samples_[static_cast<std::size_t>(k)] - position).squaredNorm();
  };
  const int nearest = control::NearestOfAll(distance, first, last);
  // An object that is nearest to an end of the stretch, but not of the route, is beyond the stretch.
  if ((nearest == first && first > 0) || (nearest == last && last < end)) return std::nullopt;
  return ObjectOnRoad(object, route_, route_.Project(position, nearest * spacing_));
}

std::vector<std::optional<RoadBody>> Surroundings::OnRoad(std::span<const control::Obstacle> objects,
                                                          double s) const {
  std::vector<std::optional<RoadBody>> bodies;
  bodies.reserve(objects.size());
  for (const control::Obstacle& object : objects) bodies.push_back(OnRoad(object, s));
  return bodies;
}

}  // namespace sim
