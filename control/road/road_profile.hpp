// The road as the control path needs it: the route sampled at equal steps of arc length s [m], with the speed that
// friction, comfort and the end of the route allow. Look-ups take constant time and do not allocate.
//
//   v(s) ≤ target speed,   v² |κ| ≤ lateral limit,   d(v²)/ds ≥ −2 deceleration,   v(length) = 0
#pragma once

#include <optional>
#include <vector>

#include "control/road/route.hpp"
#include "control/vehicle/types.hpp"

namespace control {

struct SpeedLimits {
  double lateral = 3.0;       // in curves [m/s²], > 0
  double acceleration = 1.5;  // [m/s²], > 0
  double deceleration = 2.0;  // [m/s²], > 0
  double emergency = 5.0;     // deceleration before what cannot be passed [m/s²], > 0
};

class RoadProfile {
 public:
  static constexpr double kSpacing = 0.5;      // of the samples [m]
  static constexpr double kStopWithin = 0.25;  // so near before a place to stop at, the speed is 0 [m]

  RoadProfile(const Route& route, const RoadBounds& road, const SpeedLimits& limits);

  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] const RoadBounds& road() const { return road_; }
  [[nodiscard]] const SpeedLimits& limits() const { return limits_; }

  // `speed` is the profile's; straight on before the start, and after the end with speed 0.
  [[nodiscard]] RoutePoint At(double s) const;
  // The nearest point of the course that is reached from s = `hint` without passing a further one.
  [[nodiscard]] RouteProjection Project(const Eigen::Vector2d& position, double hint) const;
  // The nearest point of the whole course, among those whose heading differs by less than π/2 from `psi`: of several
  // within 1 m of the least distance the first, so that a circuit begins with its first lap. Not for every cycle.
  [[nodiscard]] RouteProjection Find(const Eigen::Vector2d& position, double psi) const;

 private:
  std::vector<RoutePoint> points_;  // at k spacing_
  double spacing_;
  double length_;
  RoadBounds road_;
  SpeedLimits limits_;
};

// Highest speed from which `deceleration` [m/s²] stops within `distance` [m]; 0 if that is within kStopWithin.
[[nodiscard]] double StoppingSpeed(double distance, double deceleration);

}  // namespace control
