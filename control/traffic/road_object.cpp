#include "control/traffic/road_object.hpp"

#include <cmath>

#include "control/road/keep_out.hpp"
#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {
namespace {

constexpr double kStands = 0.3;  // speed below which no direction of motion is known [m/s]
constexpr double kCrossingSlope =
    0.5;  // lateral velocity per speed along the road from which an object crosses it

}  // namespace

RoadObject PlaceOnRoad(const Obstacle& obstacle, std::size_t index, const RoadProfile& profile, double hint) {
  const RouteProjection place = profile.Project({obstacle.X, obstacle.Y}, hint);
  const double psi = profile.At(place.s).psi;
  const Eigen::Vector2d along = Along(psi), left = LeftOf(psi);
  const Eigen::Vector2d velocity(obstacle.velocity_X, obstacle.velocity_Y);
  const double speed = along.dot(velocity), drift = left.dot(velocity);
  return {.index = index,
          .s = place.s,
          .lateral = place.lateral,
          .speed = speed,
          .drift = drift,
          .along = along,
          .half_length = SupportOf(obstacle, along),
          .half_width = SupportOf(obstacle, left),
          .crosses = velocity.norm() < kStands || std::abs(drift) > kCrossingSlope * std::abs(speed),
          .side = obstacle.side,
          .object_class = obstacle.object_class};
}

Obstacle Predict(const Obstacle& obstacle, const RoadObject& object, const RoadProfile& profile,
                 double time) {
  if (object.crosses) return Predict(obstacle, time);
  const RoutePoint from = profile.At(object.s), to = profile.At(object.SAt(time));
  const Eigen::Vector2d centre = Beside(to, object.LateralAt(time));
  Obstacle moved = obstacle;
  moved.X = centre.x();
  moved.Y = centre.y();
  moved.heading += to.psi - from.psi;
  return moved;
}

}  // namespace control
