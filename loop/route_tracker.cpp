#include "loop/route_tracker.hpp"

#include <algorithm>

#include "loop/route_place.hpp"

namespace loop {

RouteTracker::RouteTracker(const RouteTrackerSettings& settings, const control::TimeReference& reference,
                           const control::RoadBounds& road, int horizon)
    : settings_(settings),
      reference_(&reference),
      road_(road),
      horizon_(horizon),
      stop_(settings.stop, reference) {}

void RouteTracker::Reconfigure(double max_heading_error, double standstill_speed) {
  settings_.max_heading_error = max_heading_error;
  settings_.standstill_speed = standstill_speed;
}

RoutePlace RouteTracker::Advance(const Snapshot& known, bool commanding, const control::Input& applied) {
  bool on_route = commanding;
  if (!commanding && known.state_fresh) {
    const auto found = FindOnRoute(*reference_, road_, known.state.z, settings_.max_heading_error);
    on_route = found.has_value();
    start_step_ = known.step - found.value_or(0);
    if (found) stop_.Start(known.state.z, *found);
  }
  if (commanding && settings_.by_progress) {
    start_step_ = known.step - stop_.place();
  }
  if (commanding) {
    stop_.Advance(known.state_new && known.state_fresh ? &known.state.z : nullptr, applied);
  }
  if (!on_route) return {};
  const std::int64_t k = known.step - start_step_;
  RoutePlace place{.on_route = true, .point = static_cast<int>(k)};
  if (!settings_.by_progress) {
    place.steps_left = reference_->size() - horizon_ - k;
  } else if (!Arrived(known)) {
    place.steps_left = std::max<std::int64_t>(reference_->size() - k, 1);
  }
  return place;
}

bool RouteTracker::Arrived(const Snapshot& known) const {
  constexpr double kWithin = 2.0;  // of the last point [m]
  const control::State& end = (*reference_)[reference_->size() - 1];
  return known.state_fresh && known.state.z[control::kUpsilon] < settings_.standstill_speed &&
         (known.state.z - end).head<2>().norm() < kWithin;
}

}  // namespace loop
