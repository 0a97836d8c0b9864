// The passing side of every object (paper, assum_1) for a vehicle that reaches each station of the road at a given time:
// a dynamic program over stations and lateral positions finds the way through the gaps that costs the least time. Objects
// are where they will be when the vehicle is there, so that whom it meets, when and for how long is part of the decision.
//
// Costs are in seconds: distance from the reference path and lateral movement, the time lost where a gap is narrow or the
// way turns so sharply that the vehicle has to slow down, and the change of a passing side (hysteresis).
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "control/road/road_profile.hpp"
#include "control/road/stations.hpp"
#include "control/traffic/gaps.hpp"
#include "control/traffic/manoeuvre_status.hpp"
#include "control/traffic/road_objects.hpp"
#include "control/traffic/speed_plan.hpp"
#include "control/vehicle/footprint.hpp"

namespace control {

struct CorridorSettings {
  Footprint footprint;
  double obstacle_margin = 0.3;  // usual gap to obstacles [m]
  double road_margin = 0.4;      // usual gap to the road's edges [m]
  double grip = 5.0;             // acceleration that the tyres can provide [m/s²]
  double deceleration = 3.5;     // with which the vehicle could stop behind an object [m/s²]
};

// What is asked of a way.
struct WayTerms {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  bool squeeze = false;  // the margins are the least ones
  double waits = 0.0;    // until then, a vehicle that waits at the last station waits there [s]
  // The time from which the way must be beside, and not behind, an object that moves ahead where the vehicle could not stop
  // behind it any more; never: it keeps its distance anyway [s].
  double leaves = kNever;
  // Time by which objects may be earlier or later that come towards the vehicle, cross or overtake it, and that the previous
  // way did not count with: a gap that is only just long enough would be taken and given up by turns. Twice this for an
  // object that the vehicle yields to [s].
  double spare = 0.0;
};

// A way: at each station the gap that it goes through, and where.
struct Way {
  std::array<Gap, kStations> gap{};
  StationValues lateral{};                      // left positive [m]
  std::array<Side, RoadObjects::kMost> side{};  // on which each object is passed; kNone: it is not met
  std::size_t reached = 0;                      // number of stations from the vehicle on that it leads to
  double changes = 0.0;                         // cost of changed sides [s]
};

class Corridor {
 public:
  // `profile` must outlive this object.
  Corridor(const CorridorSettings& settings, const RoadProfile& profile)
      : settings_(settings), profile_(&profile) {}

  // What the tyres can provide from now on, and what the vehicle could brake with, as in the settings.
  void SetGrip(double grip, double deceleration) {
    settings_.grip = grip;
    settings_.deceleration = deceleration;
  }

  // The best way through the stations that `speeds` reaches; if there is none, the one that leads farthest. `kept`: the
  // previous side of each object.
  void Find(const Stations& stations, const RoadPosition& vehicle, std::span<const RoadObject> objects,
            std::span<const Side> kept, const SpeedPlan& speeds, const WayTerms& terms, Way& way);

  // The objects beside the vehicle between stations j − 1 and j, j ≥ 1, or too near to it by the terms, as indices; valid until
  // the next call. `kept`: as for Find, if there are terms.
  [[nodiscard]] std::span<const std::size_t> Beside(const Stations& stations,
                                                    std::span<const RoadObject> objects,
                                                    const SpeedPlan& speeds, std::size_t j,
                                                    const WayTerms& terms = {},
                                                    std::span<const Side> kept = {});

 private:
  static constexpr int kCells = 25;  // lateral positions at each station
  struct Cell {
    float cost = 0.0F;     // of the best way to here [s]; infinite: none
    float lateral = 0.0F;  // [m]
    short from = 0;        // cell at the station before
    short gap = -1;        // none: blocked
  };

  [[nodiscard]] RoadBounds NarrowestAt(double s, double step) const;
  void FindGaps(const Stations& stations, const RoadPosition& vehicle, std::span<const RoadObject> objects,
                std::span<const Side> kept, const SpeedPlan& speeds, std::size_t j, const WayTerms& terms);
  void Reach(std::size_t j, const Stations& stations, const RoadPosition& vehicle,
             std::span<const RoadObject> objects, std::span<const Side> kept, const SpeedPlan& speeds);

  CorridorSettings settings_;
  const RoadProfile* profile_;
  double rightmost_ = 0.0, step_ = 0.0;  // lateral position of the first cell, and spacing of the cells [m]
  std::array<std::size_t, RoadObjects::kMost> beside_{};
  std::array<bool, RoadObjects::kMost> met_{};
  std::array<Covered, RoadObjects::kMost> covered_{};
  std::array<Gaps, kStations> gaps_;
  std::array<std::array<Cell, kCells>, kStations> cells_{};
};

}  // namespace control
