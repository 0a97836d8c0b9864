#include "loop/route_tracker.hpp"

#include "loop/find_on_route.hpp"

namespace loop {

RouteTracker::RouteTracker(const RouteTrackerSettings& settings, const control::TimeReference& reference,
                           const control::RoadProfile& profile)
    : settings_(settings),
      reference_(&reference),
      profile_(&profile),
      odometer_(settings.vehicle, settings.t_s, reference) {}

void RouteTracker::Reconfigure(double max_heading_error, double standstill_speed) {
  settings_.max_heading_error = max_heading_error;
  settings_.standstill_speed = standstill_speed;
}

control::RoutePlace RouteTracker::Advance(const Snapshot& known, bool commanding,
                                          const control::Input& applied) {
  control::RoutePlace place{.on_route = commanding, .samples = reference_->size()};
  if (commanding) {
    place.nearest = odometer_.motion().nearest;
    odometer_.Advance(known.state_new && known.state_fresh ? &known.state.z : nullptr, applied);
  } else if (known.state_fresh) {
    const auto found =
        FindOnRoute(*reference_, profile_->edges(), known.state.z, settings_.max_heading_error);
    place.on_route = found.has_value();
    place.nearest = found.value_or(0);
    start_step_ = known.step - place.nearest;
    if (found) odometer_.Start(known.state.z, *found);
  }
  place.s = reference_->ArcLength(place.nearest);
  place.arrived = place.on_route && Arrived(known, place.s);
  place.due = known.step - start_step_;
  return place;
}

bool RouteTracker::Arrived(const Snapshot& known, double s) const {
  constexpr double kWithin = 0.5;  // arc length before the end [m]
  const control::State& z = known.state.z;
  return known.state_fresh && z[control::kUpsilon] < settings_.standstill_speed &&
         profile_->Project(z.head<2>(), s).s > profile_->length() - kWithin;
}

}  // namespace loop
