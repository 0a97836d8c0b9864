// Where on the road the vehicle's centre may be at which time: the road without its edges and what the objects cover,
// each enlarged by the vehicle, on a grid of 1 m × 15 cm × 0.1 s.
//
// The vehicle is a rectangle along the road, with 0.1 m of free space on either side. An object is the rectangle along and
// across the road that encloses it, where it truly is at that time; one that follows our vehicle from behind is left out,
// and one that comes and would brake for it does not brake.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/scenario.hpp"

namespace tools {

// The cells across the road, from right to left: bit 0 is the rightmost.
using LateralCells = std::uint64_t;

class RoadOccupancy {
 public:
  static constexpr double kCell = 0.15;  // width of a cell [m]
  static constexpr double kTick = 0.1;   // [s]

  // Up to `until` [s]. Of the objects, those that are perceived at `known_at` [s]. The scenario must outlive it.
  RoadOccupancy(const sim::Scenario& scenario, double until, double known_at);

  // The free cells `tick` ticks after the start; none after `until`. `s` >= 0 [m].
  [[nodiscard]] LateralCells Free(int tick, double s) const {
    if (tick > ticks_) return 0;
    const std::size_t station = std::min(static_cast<std::size_t>(s), stations_ - 1);
    return free_[static_cast<std::size_t>(tick) * stations_ + station];
  }

  [[nodiscard]] int CellAt(double lateral) const;  // the nearest, 0..63
  [[nodiscard]] int ticks() const { return ticks_; }

 private:
  void Block(const control::Obstacle& object);

  const sim::Scenario* scenario_;
  int ticks_;
  std::size_t stations_;  // metres of road
  double rightmost_;      // lateral place of cell 0 [m]
  std::vector<LateralCells> free_;
};

}  // namespace tools
