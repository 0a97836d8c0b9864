// A four-wheeled vehicle that moves in the plane: x, y and yaw (dual track, three degrees of freedom).
//
// State z = [X Y υ ν ψ ω] as in control/vehicle/types.hpp, input u = [δ a]: both front wheels are steered by δ, and
// m a is the longitudinal force demanded of the tyres, shared among the wheels by their loads; a < 0 brakes and
// never reverses, a > 0 acts on the driven wheels.
//  - slip angle of a wheel: the angle between its plane and the velocity of its hub
//  - linear tyres: F_y = C_α α, unlimited
//  - saturating tyres: brush model (Fiala); F_x is limited to μ F_z, the side force to sqrt((μ F_z)² − F_x²)
//  - load transfer: quasi-static, longitudinal from a, lateral from υ ω, limited to lifting a wheel
//  - disturbances: an offset of both front wheels, gravity on an inclined road (its effect on the wheels' loads is
//    neglected), and a side wind that pushes at the centre of gravity for a while
// Below kSlipSpeed the slip is relative to that speed, so standstill is no special case: the tyres then damp
// sideways motion instead of dividing by zero, and a braked vehicle comes to rest and stays at rest, on a slope as well
// if the brake is stronger than the pull of gravity.
// With linear tyres and neither track nor height it differs from the paper's bicycle model (eq:dynamic_model)
// only in the terms which that neglects: sin δ in the front tyres' forces and cos δ in their moment.
#pragma once

#include <array>
#include <cstddef>

#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace sim {

using control::kGravity;
inline constexpr double kSlipSpeed = 1.0;  // [m/s]

enum class Tyre { kLinear, kSaturating };

// Side wind; none by default.
struct Wind {
  double from = 0.0;                  // time of the drive at which it begins [s]
  double until = 0.0;                 // and ends [s]
  double lateral_acceleration = 0.0;  // left positive [m/s²]
};

struct PlantParameters {
  control::VehicleParameters vehicle = {};  // C_alpha_f, C_alpha_r: per tyre
  double track_front = 1.6;                 // >= 0 [m]
  double track_rear = 1.6;                  // >= 0 [m]
  double height = 0.55;                     // height of the centre of gravity, >= 0 [m]
  double roll_share_front = 0.55;           // share of the front axle in the lateral load transfer, 0..1
  Tyre tyre = Tyre::kLinear;
  double mu = 0.9;               // friction coefficient of saturating tyres, > 0
  double steering_offset = 0.0;  // the front wheels stand at δ plus this [rad]
  double bank = 0.0;             // lateral inclination of the road, positive if it falls to the left [rad]
  double slope = 0.0;            // longitudinal inclination, positive uphill [rad]
  Wind wind = {};
};

enum Wheel : std::size_t { kFrontLeft, kFrontRight, kRearLeft, kRearRight, kWheels };

struct WheelForces {
  double slip = 0.0;  // α; a positive one gives a force to the left [rad]
  double F_x = 0.0;   // along the wheel [N]
  double F_y = 0.0;   // across it, left positive [N]
  double F_z = 0.0;   // load [N]
};

class Plant {
 public:
  Plant(const PlantParameters& parameters, const control::State& initial);

  // Performs one step h > 0 [s] of the classical fourth-order Runge-Kutta method, given the input at the step's start,
  // middle and end.
  void Step(const control::Input& start, const control::Input& middle, const control::Input& end, double h);

  [[nodiscard]] const control::State& state() const { return state_; }  // ψ is not wrapped

  // At the present time, which decides whether there is wind.
  [[nodiscard]] control::State Derivative(const control::State& z, const control::Input& u) const;
  [[nodiscard]] std::array<WheelForces, kWheels> Forces(const control::State& z,
                                                        const control::Input& u) const;

 private:
  [[nodiscard]] double WheelAngle(const control::Input& u) const;
  [[nodiscard]] Eigen::Vector2d Pull() const;
  [[nodiscard]] bool BrakeHolds(const control::Input& u) const;
  [[nodiscard]] std::array<double, kWheels> Loads(const control::State& z, const control::Input& u) const;
  [[nodiscard]] std::array<double, 2> DriveForcePerLoad(double acceleration,
                                                        const std::array<double, kWheels>& loads) const;

  PlantParameters parameters_;
  std::array<Eigen::Vector2d, kWheels> hubs_;  // positions in the body frame [m]
  control::State state_;
  double time_ = 0.0;  // since the start [s]
};

}  // namespace sim
