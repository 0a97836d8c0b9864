// Tracks a vehicle along a time reference: from measured states or, without one, by dead reckoning from the commands
// with the steady-state cornering of the single-track model (steady_cornering.hpp).
#pragma once

#include "control/road/time_reference.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// Below this speed the sideslip angle is taken as zero and the wheels are held [m/s].
inline constexpr double kMinSteeringSpeed = 0.5;

struct RouteMotion {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  // position in the map [m]
  double psi = 0.0;                             // heading [rad]
  double travel_direction = 0.0;                // direction of the velocity: ψ plus the sideslip angle [rad]
  double speed = 0.0;                           // ≥ 0 [m/s]
  int nearest = 0;                              // sample of the reference beside the vehicle
};

class Odometer {
 public:
  // `reference` must outlive this object. `t_s` is the cycle time [s].
  Odometer(const VehicleParameters& vehicle, double t_s, const TimeReference& reference)
      : vehicle_(vehicle), t_s_(t_s), reference_(&reference) {}

  // Starts at `z`, beside sample k of the reference.
  void Start(const State& z, int k);
  // Advances by one cycle: to `measured` or, if that is null, to where `applied` has taken the vehicle.
  void Advance(const State* measured, const Input& applied);

  [[nodiscard]] const RouteMotion& motion() const { return motion_; }

 private:
  VehicleParameters vehicle_;
  double t_s_;
  const TimeReference* reference_;
  RouteMotion motion_;
};

// The first local minimum of the distance to `p`, searched forwards from sample `from` over at most 2000 samples.
[[nodiscard]] int NearestAhead(const TimeReference& reference, const Eigen::Vector2d& p, int from);

}  // namespace control
