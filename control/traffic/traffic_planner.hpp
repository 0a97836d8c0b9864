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
#include "control/traffic/manoeuvre.hpp"
#include "control/traffic/manoeuvre_search.hpp"
#include "control/traffic/road_objects.hpp"
#include "control/traffic/traffic_settings.hpp"
#include "control/vehicle/types.hpp"

namespace control {

class TrafficPlanner {
 public:
  // `profile` must outlive the planner.
  TrafficPlanner(const TrafficSettings& settings, const RoadProfile& profile);

  // The acceleration that the tyres can provide from now on [m/s²].
  void SetGrip(double grip) { search_.SetGrip(grip); }
  // Plans for a vehicle at this place. The manoeuvre belongs to the planner and is valid until the next call. Does not
  // allocate.
  [[nodiscard]] const Manoeuvre& Plan(std::span<const Obstacle> obstacles, const RoadPosition& vehicle);
  // Forgets the last manoeuvre.
  void Reset();

 private:
  static constexpr std::size_t kIds = 256;

  [[nodiscard]] Side& Kept(const Obstacle& obstacle);
  [[nodiscard]] LateralPoint Start(const RoadPosition& vehicle) const;
  void Take(const Candidate& candidate, Decision decision, Reason reason, std::optional<std::size_t> object,
            std::span<const Obstacle> obstacles);

  TrafficSettings settings_;
  ManoeuvreSearch search_;
  std::array<Side, kIds> kept_by_id_{};
  std::array<Side, RoadObjects::kMost> kept_{};
  Candidate go_, behind_;
  bool stays_behind_ = false;
  int open_cycles_ = 0;  // consecutive cycles in which it could have gone
  int late_cycles_ = 0;  // consecutive cycles in which going was found to be late
  Manoeuvre manoeuvre_;
};

}  // namespace control
