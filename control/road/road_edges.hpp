// The edges of a road: their distances from the reference path, piecewise linear in its arc length s [m]. Before the
// first sample and after the last one, the distances stay what they are there.
//
// Example: a road that narrows from 8 m to 4 m between s = 100 m and s = 140 m.
//   const std::array samples{control::RoadSample{.s = 100.0, .bounds = {.left = 4.0, .right = -4.0}},
//                            control::RoadSample{.s = 140.0, .bounds = {.left = 2.0, .right = -2.0}}};
//   const control::RoadEdges edges(samples);
//   edges.At(120.0);  // 3 m to the left, −3 m to the right
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "control/vehicle/types.hpp"

namespace control {

struct RoadSample {
  double s = 0.0;  // [m]
  RoadBounds bounds = {};
};

class RoadEdges {
 public:
  // A road of constant width. Implicit, since most roads are one.
  RoadEdges(const RoadBounds& everywhere = {});
  // Throws std::invalid_argument, which names the sample, if there are none, s does not rise from one to the next, a value
  // is not finite or the left edge is not left of the right one.
  explicit RoadEdges(std::span<const RoadSample> samples);

  // Takes a time that depends only on the number of samples within half a metre, and does not allocate.
  [[nodiscard]] RoadBounds At(double s) const;

  // The bounds where they are narrowest between two arc lengths, from ≤ to: the least distance of each edge. Takes a time
  // that grows with the number of samples between them, and does not allocate.
  [[nodiscard]] RoadBounds Narrowest(double from, double to) const;

  // The greatest distance of an edge from the reference path [m], at least 0.
  [[nodiscard]] double Widest() const { return widest_; }

  // The road without a strip of this width [m] along each edge.
  [[nodiscard]] RoadEdges Inset(double width) const;

 private:
  // The last sample that is not after s, which is between the first sample and the last one.
  [[nodiscard]] std::size_t Before(double s) const;

  std::vector<RoadSample> samples_;
  double widest_;
  // For each cell of kCell metres from the first sample on, the last sample that is not after the cell's begin.
  std::vector<std::size_t> cells_;
};

}  // namespace control
