#include "control/traffic/gaps.hpp"

#include <algorithm>

namespace control {
namespace {

// Two objects on the right of a gap as one: its edge and margins are nowhere less than those of either.
Covered Outermost(const Covered& a, const Covered& b) {
  const double left = std::max(a.left, b.left);
  const double least = std::max(a.left + a.margin.least, b.left + b.margin.least);
  const double wanted_a = a.left + a.margin.wanted, wanted_b = b.left + b.margin.wanted;
  return {.left = left,
          .margin = {.least = least - left,
                     .wanted = std::max(wanted_a, wanted_b) - left,
                     .speed = wanted_b > wanted_a ? b.margin.speed : a.margin.speed}};
}

Covered Mirrored(const Covered& object) {
  return {.right = -object.left, .left = -object.right, .margin = object.margin};
}

}  // namespace

void Gaps::Find(const Covered& road, std::span<Covered> covered, double half_width) {
  count_ = 0;
  std::ranges::sort(covered, {}, [](const Covered& object) { return object.right - object.margin.wanted; });
  Covered right = road;
  for (std::size_t k = 0; k <= covered.size(); ++k) {
    Covered left = Mirrored(road);
    for (std::size_t l = covered.size(); l-- > k;) left = Outermost(left, Mirrored(covered[l]));
    Add(right.left, right.margin, -left.left, left.margin, half_width);
    if (k < covered.size()) right = Outermost(right, covered[k]);
  }
}

void Gaps::Add(double right, const Margin& margin_right, double left, const Margin& margin_left,
               double half_width) {
  const double room = left - right - 2.0 * half_width;
  const double least = margin_right.least + margin_left.least;
  if (room < least || count_ == kMost) return;
  const double wanted = margin_right.wanted + margin_left.wanted;
  const double r = room < wanted ? (room - least) / (wanted - least) : 1.0;
  const double lo = right + half_width + margin_right.At(r);
  // Margins that shrink leave no play, and round-off must not make it negative.
  gaps_[count_++] = {.lo = lo,
                     .hi = std::max(left - half_width - margin_left.At(r), lo),
                     .share = r,
                     .speed = SpeedInGap(r, std::min(margin_right.speed, margin_left.speed))};
}

}  // namespace control
