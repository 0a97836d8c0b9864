// The vehicle's place on the route: searched for while commands are disabled, tracked by an odometer while enabled.
#pragma once

#include <cstdint>

#include "control/road/odometer.hpp"
#include "control/road/road_profile.hpp"
#include "control/road/route_place.hpp"
#include "control/road/time_reference.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"
#include "loop/inbox.hpp"

namespace loop {

struct RouteTrackerSettings {
  control::VehicleParameters vehicle;
  double t_s = 0.05;               // [s]
  double max_heading_error = 0.5;  // angle between vehicle and route at engagement [rad], 0..π
  double standstill_speed = 0.3;   // speed below which the vehicle stands [m/s]
};

class RouteTracker {
 public:
  // `reference` and `profile`, both of the same route, must outlive the tracker.
  RouteTracker(const RouteTrackerSettings& settings, const control::TimeReference& reference,
               const control::RoadProfile& profile);

  // Must be called once per cycle. `commanding`: commands are enabled; the vehicle then counts as on the route, beside
  // the sample of the previous cycle. `applied`: the last command.
  [[nodiscard]] control::RoutePlace Advance(const Snapshot& known, bool commanding,
                                            const control::Input& applied);

  // The vehicle's motion in this cycle; meaningless off the route.
  [[nodiscard]] const control::RouteMotion& motion() const { return odometer_.motion(); }

  void Reconfigure(double max_heading_error, double standstill_speed);

 private:
  // True if the vehicle stands at the route's end. This is asked of its progress, not of its distance from the last point,
  // which a circuit or a crossing passes several times.
  [[nodiscard]] bool Arrived(const Snapshot& known, double s) const;

  RouteTrackerSettings settings_;
  const control::TimeReference* reference_;
  const control::RoadProfile* profile_;
  control::Odometer odometer_;
  std::int64_t start_step_ = 0;  // sample k of the reference is due at step start_step_ + k
};

}  // namespace loop
