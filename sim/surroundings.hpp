// The objects near the vehicle in road coordinates. On a route that meets itself, in laps or crossings, an object is
// beside the stretch of the route that the vehicle is on, not another one that is nearer.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "control/road/route.hpp"
#include "control/vehicle/types.hpp"
#include "sim/road_body.hpp"

namespace sim {

class Surroundings {
 public:
  // The stretch about the vehicle [m].
  static constexpr double kBehind = 50.0;
  static constexpr double kAhead = 200.0;

  explicit Surroundings(const control::Route& route);

  // For each object, in their order; none if it is not beside the stretch about a vehicle at arc length `s`.
  [[nodiscard]] std::vector<std::optional<RoadBody>> OnRoad(std::span<const control::Obstacle> objects,
                                                            double s) const;

 private:
  [[nodiscard]] std::optional<RoadBody> OnRoad(const control::Obstacle& object, double s) const;

  control::Route route_;
  std::vector<Eigen::Vector2d> samples_;  // spaced evenly from start to end
  double spacing_;
};

}  // namespace sim
