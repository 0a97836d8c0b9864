// The dynamic program of space_time_way.hpp: from one start, among the objects of one occupancy.
//
// Speeds are whole levels, places along the road whole spacings and times whole steps, chosen so that a step that changes
// the speed by whole levels leads from a point of this grid to another. Of each point, the lateral cells are known from
// which there is a way, as bits; a step moves all of them at once, tick by tick.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/scenarios/possible_way.hpp"
#include "tools/scenarios/road_occupancy.hpp"

namespace tools {

struct PointMass {
  int tick = 0;        // since the start of the scenario
  double s = 0.0;      // [m]
  double speed = 0.0;  // [m/s]
  int cell = 0;        // of the occupancy
};

class SpaceTimeSearch {
 public:
  // `friction_share`: of μ g, the greatest acceleration. `intended`: what the vehicle was to do from the start on, at
  // every tick; not empty. All must outlive the search.
  SpaceTimeSearch(const sim::Scenario& scenario, const RoadOccupancy& occupancy, double friction_share,
                  std::span<const PointMass> intended);

  [[nodiscard]] PossibleWay way() const;

  // The fastest way that passes, at every tick from the start to the route's end, as near to the cell as it can be.
  // way() must be kPass.
  [[nodiscard]] std::vector<PointMass> FastestWay(int wanted_cell) const;

 private:
  // The cells from which there is a way to the end or to a standstill.
  struct Ways {
    LateralCells pass = 0;
    LateralCells stop = 0;
  };
  struct Tick {
    double ahead = 0.0;   // of the step's begin [m]
    bool shifts = false;  // whether the vehicle can move sideways by a cell
  };
  // A step from one level of speed to another.
  struct Move {
    int change = 0;   // of the level
    int after = 0;    // level
    int advance = 0;  // of the place
    std::vector<Tick> ticks;
  };
  static constexpr std::array kChanges{1, 0, -1, -2};  // the fastest first
  // The greatest levels at a place.
  struct Limits {
    int target = 0;             // by the target speed
    std::array<int, 3> grip{};  // by grip, for changes of 0, 1 and 2 levels in a step
  };

  void SetMoves();
  void SetLimits(const sim::Scenario& scenario);
  void SetWindows();
  void Solve();
  [[nodiscard]] bool Allowed(int place, int level, const Move& move) const;
  [[nodiscard]] std::size_t Index(int layer, int place, int level) const;
  [[nodiscard]] Ways At(int layer, int place, int level) const;
  // The cells that are free at tick `t` of a move that begins at `place` in `layer`, and within reach of what was intended.
  [[nodiscard]] LateralCells FreeAt(int layer, int place, const Move& move, int t) const;
  // Those at tick `from` of the move from which it leads to `goal`.
  [[nodiscard]] Ways Before(int layer, int place, const Move& move, int from, Ways goal) const;
  [[nodiscard]] const Move& FastestMove(int layer, int place, int level, int cell) const;

  const RoadOccupancy* occupancy_;
  std::span<const PointMass> intended_;
  PointMass start_;
  double length_;   // of the route [m]
  double grip_;     // [m/s²]
  int step_ticks_;  // ticks of a step
  double step_;     // [s]
  int start_level_ = 0;
  double level_ = 0.0;    // [m/s]
  double spacing_ = 0.0;  // [m]
  int levels_ = 0, places_ = 0, layers_ = 0;
  std::vector<std::vector<Move>> moves_;  // by the level before
  std::vector<Limits> limits_;            // by place
  std::vector<LateralCells> windows_;     // within reach of what was intended, by ticks since the start
  std::vector<Ways> ways_;                // by layer, place and level
};

}  // namespace tools
