// A line across the road that the vehicle's centre must not pass; it may move along the road.
#pragma once

namespace control {

struct StopLine {
  double s = 0.0;      // current arc length [m]
  double speed = 0.0;  // ≥ 0 [m/s]
  double spare = 0.0;  // distance beyond it that is kept only for comfort [m]

  // Deceleration at which an object that moves ahead is taken to be able to brake [m/s²].
  static constexpr double kHardest = 8.0;
  // Distance in which an object at this speed stops then [m].
  static constexpr double HardestStop(double object_speed) {
    return object_speed * object_speed / (2.0 * kHardest);
  }
  // Distance in which a vehicle at arc length s must be able to stop in case the line's object brakes at its hardest [m].
  [[nodiscard]] double RoomToStop(double at) const { return s + spare + HardestStop(speed) - at; }
};

}  // namespace control
