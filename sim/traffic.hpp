// The scenario's objects as they truly are, whether perceived or not: at constant velocity in the map, along the route
// as their profile says, or driven by somebody who keeps to the route and a distance to our vehicle (sim/follower.hpp)
// while that is ahead and covers offsets that the follower covers.
#pragma once

#include <optional>
#include <vector>

#include "control/road/route.hpp"
#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"
#include "sim/road_body.hpp"
#include "sim/route_motion.hpp"
#include "sim/scenario.hpp"

namespace sim {

class Traffic {
 public:
  // At the scenario's start.
  explicit Traffic(const Scenario& scenario);

  // Moves on to `time` [s] after the start. The vehicle was at `z` before; followers react to that.
  void Advance(double time, const control::State& z);

  // Those that have not disappeared, in the scenario's order.
  [[nodiscard]] std::vector<control::Obstacle> Now() const;
  // Whether the object has appeared.
  [[nodiscard]] bool IsPerceived(int id) const;

 private:
  struct Object {
    control::Obstacle start;
    std::optional<RouteMotion> motion;  // none: constant velocity
    RouteState place;                   // of a follower, now
    double appears_at = 0.0;
    std::optional<double> disappears_at;
  };

  [[nodiscard]] control::Obstacle Where(const Object& object) const;
  void Follow(Object& follower, const RoadBody& vehicle, double duration) const;

  control::Route route_;
  control::Footprint footprint_;
  std::vector<Object> objects_;
  double time_ = 0.0;
  std::optional<double> hint_;  // the vehicle's place on the route
};

}  // namespace sim
