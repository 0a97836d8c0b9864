// On which side each obstacle is passed (paper, assum_1), decided where nobody says it: obstacles that are met at the
// same place leave gaps between one another and the road's edges, and the vehicle takes the one that is wide enough and
// asks the least of it. Where there is none it stops before the obstacle.
//
// A decision is kept while it can be, so that noise does not turn the wheel.
#pragma once

#include <array>
#include <span>

#include "control/road/road_profile.hpp"
#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"

namespace control {

struct PassingSettings {
  Footprint footprint;
  double margin = 0.3;       // to obstacles [m]
  double road_margin = 0.1;  // to the road's edges [m]
  double grip = 5.0;         // acceleration that can be asked of the tyres [m/s²]
  double look_ahead = 8.0;   // obstacles met later do not matter yet [s]
};

enum class Passage { kIgnored, kLeft, kRight, kStop };

// What is decided about an obstacle, and where on the course it is when the vehicle meets it.
struct PassingDecision {
  Passage passage = Passage::kIgnored;
  double s = 0.0;            // of its centre now, on the course [m]
  double speed = 0.0;        // along the course [m/s]
  double half_length = 0.0;  // along the course [m]
};

class PassingPlanner {
 public:
  static constexpr std::size_t kMostObstacles = 16;

  PassingPlanner(const PassingSettings& settings, const RoadProfile& course)
      : settings_(settings), course_(&course) {}

  // A decision for each obstacle, in their order; they belong to the planner until the next call. The vehicle is at `s` on
  // the course, `lateral` left of it, and drives at `upsilon`.
  // Obstacles beyond the first kMostObstacles get none.
  [[nodiscard]] std::span<const PassingDecision> Decide(std::span<const Obstacle> obstacles, double s,
                                                        double lateral, double upsilon);
  void Reset() { kept_ = {}; }

 private:
  // An obstacle in road coordinates at the time at which it is met.
  struct Meeting {
    std::size_t index = 0;
    double s = 0.0;        // of its centre, then
    double time = 0.0;     // until the vehicle's front is there
    double lateral = 0.0;  // of its centre, then
    double half_length = 0.0;
    double half_width = 0.0;
  };

  [[nodiscard]] Meeting Meet(std::span<const Obstacle> obstacles, std::size_t index, double s, double upsilon,
                             PassingDecision& decision) const;
  // Decides the group of obstacles met at one place; returns the lateral place of the gap taken.
  double DecideGroup(std::span<const Obstacle> obstacles, std::span<Meeting> group, double from, double time,
                     double distance, double upsilon);
  [[nodiscard]] bool Allowed(const Obstacle& obstacle, Passage passage) const;
  [[nodiscard]] Passage& Kept(const Obstacle& obstacle);

  PassingSettings settings_;
  const RoadProfile* course_;
  std::array<Passage, kMostObstacles> kept_{};  // by id, modulo
  std::array<Meeting, kMostObstacles> meetings_{};
  std::array<PassingDecision, kMostObstacles> decisions_{};
};

}  // namespace control
