// Where a vehicle is on its route, in samples of the time reference.
#pragma once

#include <algorithm>
#include <cstdint>

namespace control {

struct RoutePlace {
  bool on_route = false;  // between the road's edges and heading along it; otherwise the rest is meaningless
  int nearest = 0;        // sample beside the vehicle
  double s = 0.0;         // arc length of the route at that sample [m]
  std::int64_t due =
      0;  // sample at which the vehicle would be, had it kept to the reference's times since engagement
  int samples = 0;       // number of samples of the route
  bool arrived = false;  // the vehicle stands at the end
};

// A controller's progress on the route.
struct RouteProgress {
  std::int64_t sample = 0;      // where its reference begins
  std::int64_t steps_left = 0;  // steps for which the route is still long enough to plan on; 0 at its end
};

// Progress of a controller whose reference begins beside the vehicle, wherever that is.
[[nodiscard]] inline RouteProgress ProgressByPlace(const RoutePlace& place) {
  return {.sample = place.nearest,
          .steps_left = place.arrived ? 0 : std::max(place.samples - place.nearest, 1)};
}

// Progress of a controller whose reference advances with time, N = `horizon` steps ahead.
[[nodiscard]] inline RouteProgress ProgressByTime(const RoutePlace& place, int horizon) {
  return {.sample = place.due, .steps_left = place.samples - horizon - place.due};
}

}  // namespace control
