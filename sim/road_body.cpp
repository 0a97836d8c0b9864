#include "sim/road_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "control/road/keep_out.hpp"
#include "control/vehicle/geometry.hpp"

namespace sim {

using Eigen::Vector2d;

RoadBody VehicleOnRoad(const control::State& z, const control::Footprint& footprint,
                       const control::Route& route, const control::RouteProjection& place) {
  const double heading = control::WrapAngle(z[control::kPsi] - route.At(place.s).psi);
  const Vector2d velocity = control::Rotate(heading, z.segment<2>(control::kUpsilon));
  RoadBody body{.s = place.s,
                .lateral = place.lateral,
                .heading = heading,
                .rear = place.s,
                .front = place.s,
                .right = place.lateral,
                .left = place.lateral,
                .speed = velocity.x(),
                .lateral_speed = velocity.y()};
  for (const Vector2d& corner : footprint.Corners()) {
    const Vector2d offset = control::Rotate(heading, corner);
    body.rear = std::min(body.rear, place.s + offset.x());
    body.front = std::max(body.front, place.s + offset.x());
    body.right = std::min(body.right, place.lateral + offset.y());
    body.left = std::max(body.left, place.lateral + offset.y());
  }
  return body;
}

RoadBody ObjectOnRoad(const control::Obstacle& object, const control::Route& route,
                      const control::RouteProjection& place) {
  const double psi = route.At(place.s).psi;
  const Vector2d along = control::Along(psi), across = control::LeftOf(psi);
  const Vector2d velocity(object.velocity_X, object.velocity_Y);
  const double half_length = control::SupportOf(object, along);
  const double half_width = control::SupportOf(object, across);
  return {.s = place.s,
          .lateral = place.lateral,
          .heading = control::WrapAngle(object.heading - psi),
          .rear = place.s - half_length,
          .front = place.s + half_length,
          .right = place.lateral - half_width,
          .left = place.lateral + half_width,
          .speed = along.dot(velocity),
          .lateral_speed = across.dot(velocity)};
}

}  // namespace sim
