// The path along which a vehicle is brought to a stop: that of a plan and, beyond its end, one beside the road into which
// the plan's last direction decays. So a stop does not steer back into what the plan avoided.
//
// The offset d from the road's path continues with the slope d' at the plan's end, over the distance x beyond it:
//
//   d(x) = d_end + d'_end ℓ (1 − exp(−x/ℓ))          ℓ is as short as a comfortable lateral acceleration allows
//
// A vehicle beside the path is steered back by feedforward and feedback in arc length, critically damped:
//
//   κ = κ_path − 2 Δχ/ℓ_s − e/ℓ_s²      e: offset from the path, Δχ: direction of travel relative to it; κ_path a little ahead
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "control/road/odometer.hpp"
#include "control/road/road_profile.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

struct StopPathPoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  // [m]
  double direction = 0.0;                       // of travel [rad]
  double curvature = 0.0;                       // [1/m]
  double s = 0.0;                               // arc length of the road beside it [m]
};

class StopPath {
 public:
  // For plans of at most `horizon` steps. Beyond a plan's end, the path keeps `half_width` [m] from the road's edges, if the
  // vehicle can turn that sharply. `profile` must outlive the path.
  StopPath(const VehicleParameters& vehicle, const RoadProfile& profile, int horizon, double half_width);

  // Lays the path along these N + 1 ≥ 1 states, but for the last few, the first of which is beside the road's arc length s [m], as found by
  // local search. Does not allocate.
  void Follow(std::span<const State> plan, double s);

  // The point at this distance from the path's begin, before which it is straight [m].
  [[nodiscard]] StopPathPoint At(double distance) const;
  // Distance along the path of the point nearest to `position`.
  [[nodiscard]] double DistanceOf(const Eigen::Vector2d& position) const;
  // δ of a vehicle at this place that follows the path [rad].
  [[nodiscard]] double Steering(const RouteMotion& motion) const;

 private:
  struct Knot {
    double distance = 0.0;
    StopPathPoint point;
  };
  [[nodiscard]] StopPathPoint Beyond(double x) const;

  VehicleParameters vehicle_;
  const RoadProfile* profile_;
  double half_width_;
  std::vector<Knot> knots_;
  double offset_ = 0.0;  // d_end [m]
  double slope_ = 0.0;   // d'_end
  double decay_ = 1.0;   // ℓ [m]
};

}  // namespace control
