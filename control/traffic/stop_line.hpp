// A line across the road that the vehicle's centre must not pass; it may move along the road.
#pragma once

namespace control {

struct StopLine {
  double s = 0.0;      // current arc length [m]
  double speed = 0.0;  // ≥ 0 [m/s]
  double spare = 0.0;  // distance beyond it that is kept only for comfort [m]

  // Deceleration at which an object that moves ahead is taken to be able to brake [m/s²].
  static constexpr double kHardest = 8.0;
  // Distance in which a vehicle at arc length s must be able to stop in case the line's object brakes at its hardest [m].
  [[nodiscard]] double RoomToStop(double at) const {
    return s + spare + speed * speed / (2.0 * kHardest) - at;
  }
};

}  // namespace control
