// Where the vehicle is on the route: looked for while others drive, followed while commands are enabled, by measured states
// or, without one, by dead reckoning from the commands.
#pragma once

#include <cstdint>
#include <span>

#include "control/road/path_stop.hpp"
#include "control/road/time_reference.hpp"
#include "control/vehicle/types.hpp"
#include "loop/inbox.hpp"

namespace loop {

struct RouteTrackerSettings {
  control::PathStopSettings stop;
  double max_heading_error = 0.5;  // between vehicle and route, at engagement [rad], 0..π
  double standstill_speed = 0.3;   // the vehicle stands below it [m/s]
  // The reference goes on from the point beside the vehicle; otherwise a point a period, wherever the vehicle is.
  bool by_progress = false;
};

// Place of the vehicle in a cycle.
struct RoutePlace {
  bool on_route = false;  // always true while commands are enabled
  int point = 0;          // of the reference, from which a plan begins
  std::int64_t steps_left =
      0;  // for which the route is long enough to plan on it; 0 off the route and at its end
};

class RouteTracker {
 public:
  // `reference` must outlive the tracker. `horizon`: N of the controller.
  RouteTracker(const RouteTrackerSettings& settings, const control::TimeReference& reference,
               const control::RoadBounds& road, int horizon);

  // Once a cycle. `commanding`: the mode enables commands. `applied`: the last command.
  [[nodiscard]] RoutePlace Advance(const Snapshot& known, bool commanding, const control::Input& applied);

  // The stop along the route ends as far beside it as this plan does: N + 1 states that begin where the vehicle is.
  void Follow(std::span<const control::State> plan) { stop_.Follow(plan); }
  // δ that keeps the vehicle on its path while it stops [rad]; `applied` is that of the last command.
  [[nodiscard]] double StopSteering(double applied) const { return stop_.Steering(applied); }

  void Reconfigure(double max_heading_error, double standstill_speed);

 private:
  [[nodiscard]] bool Arrived(const Snapshot& known) const;

  RouteTrackerSettings settings_;
  const control::TimeReference* reference_;
  control::RoadBounds road_;
  int horizon_;
  control::PathStop stop_;       // keeps the place beside the vehicle
  std::int64_t start_step_ = 0;  // point k of the reference belongs to step start_step_ + k
};

}  // namespace loop
