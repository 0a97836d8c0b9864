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
  double margin = 0.3;       // gap to obstacles [m]
  double road_margin = 0.1;  // gap to the road's edges [m]
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
    double s = 0.0;        // arc length of its centre at that time [m]
    double time = 0.0;     // time until the vehicle's front reaches it [s]
    double lateral = 0.0;  // lateral position of its centre at that time [m]
    double half_length = 0.0;
    double half_width = 0.0;
  };

  // The lateral positions of the vehicle's centre between the obstacles met at one place. Gap g is left of the first g
  // of them and right of the others.
  struct Gap {
    double lo = 0.0, hi = 0.0;  // too narrow if lo > hi [m]
    bool allowed = true;        // the gap is on the side given for each obstacle
    bool kept = true;           // the gap is on the same side of each obstacle as before
    bool stopped = false;       // the vehicle has been stopping for one of them
    int changes = 0;            // obstacles whose side changes
  };
  struct GapUse {
    double cost = 0.0;     // in metres of lateral movement
    double lateral = 0.0;  // where the vehicle passes [m]
  };

  [[nodiscard]] Meeting Meet(std::span<const Obstacle> obstacles, std::size_t index, double s, double upsilon,
                             PassingDecision& decision) const;
  // Decides the group of obstacles met at one place; returns the lateral position of the gap taken.
  double DecideGroup(std::span<const Obstacle> obstacles, std::span<Meeting> group, double from, double time,
                     double distance, double upsilon);
  [[nodiscard]] Gap GapAt(std::span<const Obstacle> obstacles, std::span<const Meeting> group, std::size_t g);
  // Width by which a gap may be too narrow [m]; negative: it must be wider than necessary by that much.
  [[nodiscard]] double Spare(const Gap& gap, bool can_stop) const;
  // Cost and lateral position of a passage through the gap within `time` [s] from lateral position `from` [m].
  [[nodiscard]] GapUse Use(const Gap& gap, double from, double time) const;
  [[nodiscard]] bool Allowed(const Obstacle& obstacle, Passage passage) const;
  [[nodiscard]] Passage& Kept(const Obstacle& obstacle);

  PassingSettings settings_;
  const RoadProfile* profile_;
  std::array<Passage, kMostObstacles> kept_{};  // indexed by id modulo the size
  std::array<Meeting, kMostObstacles> meetings_{};
  std::array<PassingDecision, kMostObstacles> decisions_{};
};

}  // namespace control
