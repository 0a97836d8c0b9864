// Decides about other things on the road, in space and time: which side each object is passed on, or behind which one
// the vehicle stays; along which path and how fast. It closes the paper's assum_1.
//
// Two manoeuvres are compared. The first goes: the vehicle drives as fast as the road allows, and a way through the gaps is
// searched among the objects as they will be when it gets there (corridor.hpp). If it must slow down for a bend of that
// way or for a narrow gap, the search is repeated with the later times. The second stays behind the object that blocks the
// first, or would be overtaken by it. The cheaper one that is possible is taken; the present one is kept unless the other
// is clearly better.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "control/road/road_profile.hpp"
#include "control/traffic/corridor.hpp"
#include "control/traffic/manoeuvre.hpp"
#include "control/traffic/path_smoother.hpp"
#include "control/traffic/road_objects.hpp"
#include "control/traffic/speed_plan.hpp"
#include "control/vehicle/footprint.hpp"

namespace control {

struct TrafficSettings {
  Footprint footprint;
  double obstacle_margin = 0.3;  // [m]
  double road_margin = 0.4;      // [m]
  double stop_gap = 2.0;         // gap to an object that blocks the way [m]
  double headway = 1.0;          // additional gap to an object that moves ahead, in time [s]
  double grip = 5.0;             // acceleration that the tyres can provide [m/s²]
  double horizon = 8.0;          // [s]
  PathSmootherSettings path;
};

class TrafficPlanner {
 public:
  // `profile` must outlive the planner.
  TrafficPlanner(const TrafficSettings& settings, const RoadProfile& profile);

  // Plans for a vehicle at this place. The manoeuvre belongs to the planner and is valid until the next call. Does not
  // allocate.
  [[nodiscard]] const Manoeuvre& Plan(std::span<const Obstacle> obstacles, const RoadPosition& vehicle);
  // Forgets the last manoeuvre.
  void Reset();

 private:
  static constexpr std::size_t kIds = 256;

  struct Candidate {
    bool possible = false;
    bool late = false;  // there is a way, but at the speeds that it allows the vehicle would be late for it
    double cost = 0.0;  // [s]
    Way way;
    SpeedPlan speeds;
    LateralPath path;
    StationValues speed_limit{};
    std::array<StopLine, Manoeuvre::kMostStops> stop_lines{};
    std::array<std::size_t, Manoeuvre::kMostStops> stop_objects{};
    std::size_t stop_count = 0;
    std::optional<std::size_t> blocker;  // the object that blocks the way
  };

  void Measure(const RoadPosition& vehicle);
  void Evaluate(const RoadPosition& vehicle, bool squeeze, Candidate& candidate);
  void EvaluateBehind(const RoadPosition& vehicle, std::optional<std::size_t> object, Candidate& candidate);
  void AddStop(std::optional<std::size_t> object, const RoadPosition& vehicle, Candidate& candidate) const;
  [[nodiscard]] std::optional<std::size_t> Blocker(const Candidate& candidate, const RoadPosition& vehicle);
  [[nodiscard]] bool Collides(const Candidate& candidate, std::size_t& object);
  void LimitSpeed(Candidate& candidate) const;
  [[nodiscard]] double Cost(const Candidate& candidate) const;
  [[nodiscard]] bool CanStop(const Candidate& candidate, const RoadPosition& vehicle) const;
  [[nodiscard]] LateralPoint Start(const RoadPosition& vehicle) const;
  void Take(const Candidate& candidate, Decision decision, std::optional<std::size_t> object,
            std::span<const Obstacle> obstacles);

  TrafficSettings settings_;
  const RoadProfile* profile_;
  RoadObjects objects_;
  Corridor corridor_;
  PathSmoother smoother_;
  Stations stations_;
  StationValues road_speed_{}, curvature_{};
  std::array<Side, kIds> kept_by_id_{};
  std::array<Side, RoadObjects::kMost> kept_{};
  Candidate go_, behind_;
  bool stays_behind_ = false;
  int open_cycles_ = 0;  // consecutive cycles in which it could have gone
  int late_cycles_ = 0;  // consecutive cycles in which going was found to be late
  Manoeuvre manoeuvre_;
};

}  // namespace control
