#include "control/traffic/gaps.hpp"

#include <algorithm>

namespace control {

void Gaps::Find(const Covered& road, std::span<Covered> covered, double half_width) {
  count_ = 0;
  std::ranges::sort(covered, {}, [](const Covered& object) { return object.right - object.margin.wanted; });
  double right = road.left;
  Margin margin = road.margin;
  for (const Covered& object : covered) {
    Add(right, margin, object.right, object.margin, half_width);
    if (object.left + object.margin.wanted > right + margin.wanted) {
      right = object.left;
      margin = object.margin;
    }
  }
  Add(right, margin, road.right, road.margin, half_width);
}

void Gaps::Add(double right, const Margin& margin_right, double left, const Margin& margin_left,
               double half_width) {
  const double room = left - right - 2.0 * half_width;
  const double least = margin_right.least + margin_left.least;
  if (room < least || count_ == kMost) return;
  const double wanted = margin_right.wanted + margin_left.wanted;
  const double r = room < wanted ? (room - least) / (wanted - least) : 1.0;
  const auto shrunk = [r](const Margin& m) { return m.least + r * (m.wanted - m.least); };
  gaps_[count_++] = {.lo = right + half_width + shrunk(margin_right),
                     .hi = left - half_width - shrunk(margin_left),
                     .share = r,
                     .speed = SpeedInGap(r, std::min(margin_right.speed, margin_left.speed))};
}

}  // namespace control
