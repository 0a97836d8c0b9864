// An object beside or on the road, in road coordinates, and its motion in the next seconds: an object that moves along
// the road keeps its speed and follows the road's bends, one that crosses the road moves straight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "control/road/road_profile.hpp"
#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"

namespace control {

struct RoadObject {
  // Time for which an object that moves along the road is assumed to keep its lateral velocity [s].
  static constexpr double kDrift = 2.0;
  static constexpr double kMoving = 0.5;  // speed from which an object is taken to move [m/s]

  std::size_t index = 0;            // in the list of obstacles
  double s = 0.0;                   // arc length of the centre [m]
  double lateral = 0.0;             // of the centre, left positive [m]
  double speed = 0.0;               // along the road [m/s]
  double drift = 0.0;               // lateral velocity, left positive [m/s]
  Eigen::Vector2d along{1.0, 0.0};  // unit vector along the road beside it
  double half_length = 0.0;         // along the road [m]
  double half_width = 0.0;          // across the road [m]
  bool crosses = false;             // moves across the road rather than along it
  bool yielded_to = false;          // the vehicle has decided to let it go first
  PassingSide side = PassingSide::kUnknown;
  ObstacleClass object_class = ObstacleClass::kUnknown;

  [[nodiscard]] double SAt(double t) const { return s + speed * t; }
  [[nodiscard]] double LateralAt(double t) const {
    return lateral + drift * (crosses ? t : std::min(t, kDrift));
  }
  // The time from which on the object can be where it is `time` [s] from now: one that hardly moves may stop at once.
  [[nodiscard]] double Since(double time) const { return Moves() ? time : 0.0; }
  [[nodiscard]] bool Moves() const { return std::hypot(speed, drift) > kMoving; }
  [[nodiscard]] bool MovesAhead() const { return !crosses && speed > kMoving; }
  [[nodiscard]] bool ComesTowards() const { return !crosses && speed < -kMoving; }

  // True if a vehicle is beside the object, before which it is by `ahead` [m] from centre to centre; or, while that
  // distance changes from `ahead` to `then`, at some time.
  [[nodiscard]] bool IsBeside(const Footprint& vehicle, double ahead) const {
    return IsBeside(vehicle, ahead, ahead);
  }
  [[nodiscard]] bool IsBeside(const Footprint& vehicle, double ahead, double then) const {
    return std::min(ahead, then) - half_length <= vehicle.front &&
           std::max(ahead, then) + half_length >= -vehicle.rear;
  }
};

// The obstacle in road coordinates, beside the road's point nearest to it by local search from s = `hint` [m].
[[nodiscard]] RoadObject PlaceOnRoad(const Obstacle& obstacle, std::size_t index, const RoadProfile& profile,
                                     double hint);

// The obstacle `time` [s] later, moved as the road object is.
[[nodiscard]] Obstacle Predict(const Obstacle& obstacle, const RoadObject& object, const RoadProfile& profile,
                               double time);

}  // namespace control
