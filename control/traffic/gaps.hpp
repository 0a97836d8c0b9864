// The gaps between the objects beside a place of the road, and between objects and the road's edges: the lateral
// positions that the vehicle's centre can take. Where a gap is too narrow for the wanted margins, they shrink to what there
// is, and with them the speed.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "control/traffic/margin.hpp"

namespace control {

// The part of the road's cross-section that an object covers, left positive [m].
struct Covered {
  double right = 0.0;
  double left = 0.0;
  Margin margin;
};

struct Gap {
  double lo = 0.0;  // lateral positions of the vehicle's centre [m]
  double hi = 0.0;
  double share = 0.0;  // of the way from the least to the wanted margins, 0..1
  double speed = 0.0;  // highest speed within it [m/s]
};

class Gaps {
 public:
  static constexpr std::size_t kMost = 12;

  // `road` covers everything that is not road: `road.left` is the right edge, `road.right` the left edge. Sorts `covered`.
  void Find(const Covered& road, std::span<Covered> covered, double half_width);

  // From right to left.
  [[nodiscard]] std::span<const Gap> gaps() const { return {gaps_.data(), count_}; }

 private:
  void Add(double right, const Margin& margin_right, double left, const Margin& margin_left,
           double half_width);

  std::array<Gap, kMost> gaps_{};
  std::size_t count_ = 0;
};

}  // namespace control
