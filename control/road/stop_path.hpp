// The path along which a vehicle is brought to a stop: that of a plan and, beyond its end, the path beside the road that
// the plan was made along. So a stop does not steer back into what the plan avoided, and passes what the plan would pass.
//
// The offset from the road's path continues with the slope at the plan's end. Over the distance x beyond it, its difference e
// from the path beside the road dies away, critically damped:
//
//   e(x) = (e_end + (e'_end + e_end/ℓ) x) exp(−x/ℓ)        ℓ is as short as a comfortable lateral acceleration allows
//
// A vehicle beside the path is steered back by feedforward and feedback in arc length, critically damped, too:
//
//   κ = κ_path − 2 Δχ/ℓ_s − e/ℓ_s²      e: offset from the path, Δχ: direction of travel relative to it; κ_path a little ahead
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "control/road/lateral_path.hpp"
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

  // Lays the path along these N + 1 ≥ 1 states, but for the last few, the first of which is beside the road's arc length s
  // [m], as found by local search; and then along `beyond` or, where that does not exist and after the length of a stop,
  // parallel to the road. Does not allocate.
  void Follow(std::span<const State> plan, double s, const LateralPath& beyond);

  // The point at this distance from the path's begin, before which it is straight [m].
  [[nodiscard]] StopPathPoint At(double distance) const;
  // Distance along the path of the point nearest to `position`, which is beside the road's arc length s [m].
  [[nodiscard]] double DistanceOf(const Eigen::Vector2d& position, double s) const;
  // δ of a vehicle that follows the path, beside the road's arc length s [m] [rad].
  [[nodiscard]] double Steering(const RouteMotion& motion, double s) const;

 private:
  static constexpr std::size_t kBeyond = 100;  // knots beyond the plan

  struct Knot {
    double distance = 0.0;
    StopPathPoint point;
  };
  // How the path leads on from the end of a plan.
  struct Transition {
    double s = 0.0;         // of the plan's end [m]
    double offset = 0.0;    // e_end [m]
    double slope = 0.0;     // e'_end
    double decay = 1.0;     // ℓ [m]
    double parallel = 0.0;  // offset of the path that is led to if there is none beside the road [m]

    // Offset from the road's path and its slope at s, beyond which `path` is followed.
    [[nodiscard]] LateralPoint At(double s, const LateralPath& path) const;
  };
  void Add(const StopPathPoint& point);
  // The point of a path beside the road.
  [[nodiscard]] StopPathPoint PointBeside(double s, const LateralPoint& path) const;
  void FollowPlan(std::span<const State> plan, double s);
  [[nodiscard]] Transition TransitionTo(const LateralPath& beyond, double upsilon) const;
  [[nodiscard]] bool LeavesRoad(const Transition& transition, const LateralPath& beyond) const;

  VehicleParameters vehicle_;
  const RoadProfile* profile_;
  double half_width_;
  std::vector<Knot> knots_;
};

}  // namespace control
