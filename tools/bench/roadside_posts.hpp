// Posts beside a route, for a controller that is to have more objects to deal with on the same drive: they stand 0.3 m
// beyond the road's edges, left and right by turns, so near that they matter (control/traffic/road_objects.hpp) and so
// far that nobody has to keep clear of them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "config/route_file.hpp"
#include "control/vehicle/types.hpp"
#include "sim/scenario.hpp"

namespace tools {

class RoadsidePosts {
 public:
  // Of the scenario's route with the road of `route`. Where the course meets itself, no post stands on the road.
  RoadsidePosts(const sim::Scenario& scenario, const config::RouteFile& route);

  // The first `count` posts that a vehicle at this position has not passed, nearest first; fewer only if the scenario's objects
  // leave no ids for them. The position is searched for on the route near the last one.
  [[nodiscard]] std::vector<control::Obstacle> Ahead(const Eigen::Vector2d& position, std::size_t count);

 private:
  struct Post {
    double s = 0.0;  // [m]
    control::Obstacle obstacle;
  };

  control::Route route_;
  std::vector<Post> posts_;
  std::size_t ids_ = 0;  // that the scenario's objects leave free
  std::optional<double> hint_;
};

}  // namespace tools
