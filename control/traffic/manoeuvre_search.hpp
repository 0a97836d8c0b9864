// Searches for manoeuvres from a place of the vehicle among the objects that matter there: one that goes, past the objects,
// or one that stays behind them (traffic_planner.hpp). Each is a way (corridor.hpp), its path and its speeds, which are made
// for one another: the way is where the objects are when the vehicle gets there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "control/road/lateral_path.hpp"
#include "control/road/road_profile.hpp"
#include "control/traffic/corridor.hpp"
#include "control/traffic/manoeuvre.hpp"
#include "control/traffic/path_smoother.hpp"
#include "control/traffic/road_objects.hpp"
#include "control/traffic/speed_plan.hpp"
#include "control/traffic/traffic_settings.hpp"

namespace control {

// A manoeuvre that may be taken.
struct Candidate {
  bool possible = false;
  bool late = false;  // there is a way, but at the speeds that it allows the vehicle would be late for it
  Reason obstacle = Reason::kWayFree;  // why it is not possible
  double cost = 0.0;                   // [s]
  Way way;
  SpeedPlan speeds;
  LateralPath path;
  StationValues speed_limit{};  // [m/s]
  std::array<StopLine, Manoeuvre::kMostStops> stop_lines{};
  std::array<std::size_t, Manoeuvre::kMostStops> stop_objects{};
  std::size_t stop_count = 0;
  std::optional<std::size_t> blocker;  // the object that blocks the way
};

enum class Caution : std::uint8_t {
  kUsual,    // with time to spare for objects that are new, and the usual margins
  kNoSpare,  // with the usual margins
  kSqueeze,  // with the least margins
};

class ManoeuvreSearch {
 public:
  // `profile` must outlive this object.
  ManoeuvreSearch(const TrafficSettings& settings, const RoadProfile& profile);

  // Forgets where the stations were.
  void Reset() { stations_ = {}; }
  // The acceleration that the tyres can provide from now on [m/s²].
  void SetGrip(double grip);
  // Sets the place of the vehicle and selects the objects; must precede the searches. `start`: where paths begin. None of
  // the functions allocates.
  void Begin(std::span<const Obstacle> obstacles, const RoadPosition& vehicle, const LateralPoint& start);

  // The vehicle yields to object k so far, so that only a way with twice the time to spare goes first.
  void YieldTo(std::size_t k) { objects_.YieldTo(k); }

  // Searches past the objects. `kept`: the previous side of each object.
  // `decided`: for how long this has been decided [s]; the longer, the sooner must the vehicle leave the lane of an object
  // that it overtakes, lest it put that off for ever.
  void Go(std::span<const Side> kept, Caution caution, double decided, Candidate& candidate);
  // Searches behind `object`, or without one behind the station at which `candidate.way` ends, and behind what else turns
  // out to block the way.
  void StayBehind(std::optional<std::size_t> object, std::span<const Side> kept, Candidate& candidate);
  // True if the tyres suffice to stop before the candidate's stop lines.
  [[nodiscard]] bool CanStop(const Candidate& candidate) const;

  [[nodiscard]] const Stations& stations() const { return stations_; }
  [[nodiscard]] const RoadObjects& objects() const { return objects_; }
  // Time to the last station at the road's speed [s].
  [[nodiscard]] double FreeTime() const { return TimeFrom(0); }

 private:
  void Measure();
  [[nodiscard]] double TimeFrom(std::size_t j) const;
  void Evaluate(std::span<const Side> kept, const WayTerms& terms, Candidate& candidate);
  void AddStop(std::optional<std::size_t> object, Candidate& candidate) const;
  [[nodiscard]] std::optional<std::size_t> Blocker(std::span<const Side> kept, const WayTerms& terms,
                                                   const Candidate& candidate);
  // Why the way leads no farther.
  [[nodiscard]] Reason Obstruction(std::span<const Side> kept, const WayTerms& terms,
                                   const Candidate& candidate);
  // The object that the path touches at the times of the speed plan, if there is one.
  [[nodiscard]] std::optional<std::size_t> Touched(const Candidate& candidate);
  void LimitSpeed(Candidate& candidate) const;
  void KeepAbleToStop(Candidate& candidate) const;
  [[nodiscard]] bool Covers(const RoadObject& o, double lateral, double from, double to, double apart) const;
  [[nodiscard]] double Cost(const Candidate& candidate) const;

  TrafficSettings settings_;
  const RoadProfile* profile_;
  SpeedLimits limits_;  // the road's, and not more than the tyres can give
  RoadObjects objects_;
  Corridor corridor_;
  PathSmoother smoother_;
  RoadPosition vehicle_;
  LateralPoint start_;
  double leaves_ = 0.0;  // time at which the vehicle leaves the lane of an object that it overtakes [s]
  Stations stations_;
  StationValues road_speed_{}, curvature_{};
};

}  // namespace control
