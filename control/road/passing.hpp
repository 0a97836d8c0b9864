// Decides on which side each obstacle is passed (paper, assum_1) where the side is not given: obstacles that are met
// at the same place leave gaps between one another and the road's edges, and the vehicle takes the gap that is wide
// enough and demands the least. If there is none, it stops before the obstacle.
//
// A decision is kept as long as possible (hysteresis), so that noise does not turn the wheel.
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
  double grip = 5.0;         // acceleration that the tyres can provide [m/s²]
  double look_ahead = 8.0;   // obstacles met later are ignored for now [s]
};

enum class Passage { kIgnored, kLeft, kRight, kStop };

// The decision about an obstacle, and the obstacle's position and motion along the road.
struct PassingDecision {
  Passage passage = Passage::kIgnored;
  double s = 0.0;            // current arc length of its centre [m]
  double speed = 0.0;        // along the road [m/s]
  double half_length = 0.0;  // along the road [m]
};

class PassingPlanner {
 public:
  static constexpr std::size_t kMostObstacles = 16;

  PassingPlanner(const PassingSettings& settings, const RoadProfile& profile)
      : settings_(settings), profile_(&profile) {}

  // Returns one decision per obstacle, in the same order; the span is valid until the next call. The vehicle is at
  // arc length `s`, `lateral` left of the road profile, and drives at `upsilon`.
  // Obstacles beyond the first kMostObstacles get no decision.
  [[nodiscard]] std::span<const PassingDecision> Decide(std::span<const Obstacle> obstacles, double s,
                                                        double lateral, double upsilon);
  void Reset() { kept_ = {}; }

 private:
  // An obstacle in road coordinates at the time at which the vehicle meets it.
  struct Meeting {
    std::size_t index = 0;
    double s = 0.0;        // arc length of its centre at that time
    double time = 0.0;     // until the vehicle's front reaches it
    double lateral = 0.0;  // lateral position of its centre at that time
    double half_length = 0.0;
    double half_width = 0.0;
  };

  [[nodiscard]] Meeting Meet(std::span<const Obstacle> obstacles, std::size_t index, double s, double upsilon,
                             PassingDecision& decision) const;
  // Decides the group of obstacles met at one place; returns the lateral position of the gap taken.
  double DecideGroup(std::span<const Obstacle> obstacles, std::span<Meeting> group, double from, double time,
                     double distance, double upsilon);
  [[nodiscard]] bool Allowed(const Obstacle& obstacle, Passage passage) const;
  [[nodiscard]] Passage& Kept(const Obstacle& obstacle);

  PassingSettings settings_;
  const RoadProfile* profile_;
  std::array<Passage, kMostObstacles> kept_{};  // indexed by id modulo the size
  std::array<Meeting, kMostObstacles> meetings_{};
  std::array<PassingDecision, kMostObstacles> decisions_{};
};

}  // namespace control
