// A vehicle with four wheels moving in the plane: x, y and yaw (dual track, three degrees of freedom).
//
// State z = [X Y υ ν ψ ω] as in control/vehicle/types.hpp, input u = [δ a]: both front wheels are steered by δ, and m a is
// the longitudinal force asked of the tyres, shared among the wheels by their load; a < 0 brakes and never
// reverses.
//  - slip angle of a wheel: between its plane and the velocity of its own hub
//  - linear tyres: F_y = C_α α, unlimited
//  - saturating tyres: brush model (Fiala) with sqrt((μ F_z)² − F_x²) left for the side, F_x limited to μ F_z
//  - load transfer: quasi-static, from a along and υ ω across, never more than lifts a wheel
// Below kSlipSpeed the slip is taken relative to that speed, so standstill needs no case of its own: the
// tyres then damp sideways motion instead of dividing by zero, and a braked vehicle comes to rest and stays.
// With linear tyres and neither track nor height it differs from the paper's bicycle (eq:dynamic_model) only
// in what that leaves out: sin δ of the front tyres' forces and cos δ in their moment.
#pragma once

#include <array>
#include <cstddef>

#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace sim {

using control::kGravity;
inline constexpr double kSlipSpeed = 1.0;  // [m/s]

enum class Tyre { kLinear, kSaturating };

struct PlantParameters {
  control::VehicleParameters vehicle;  // C_alpha_f, C_alpha_r are of one tyre
  double track_front = 1.6;            // >= 0 [m]
  double track_rear = 1.6;             // >= 0 [m]
  double height = 0.55;                // of the centre of gravity, >= 0 [m]
  double roll_share_front = 0.55;      // of the lateral load transfer, 0..1
  Tyre tyre = Tyre::kLinear;
  double mu = 0.9;  // friction coefficient of saturating tyres, > 0
};

enum Wheel : std::size_t { kFrontLeft, kFrontRight, kRearLeft, kRearRight, kWheels };

struct WheelForces {
  double slip = 0.0;  // α, positive gives a force to the left [rad]
  double F_x = 0.0;   // along the wheel [N]
  double F_y = 0.0;   // across it, left positive [N]
  double F_z = 0.0;   // load [N]
};

class Plant {
 public:
  Plant(const PlantParameters& parameters, const control::State& initial);

  // One step of the classical Runge-Kutta method of order 4, h > 0 [s]; the input at its start, middle and end.
  void Step(const control::Input& start, const control::Input& middle, const control::Input& end, double h);

  [[nodiscard]] const control::State& state() const { return state_; }  // ψ is not wrapped

  [[nodiscard]] control::State Derivative(const control::State& z, const control::Input& u) const;
  [[nodiscard]] std::array<WheelForces, kWheels> Forces(const control::State& z,
                                                        const control::Input& u) const;

 private:
  [[nodiscard]] std::array<double, kWheels> Loads(const control::State& z, const control::Input& u) const;

  PlantParameters parameters_;
  std::array<Eigen::Vector2d, kWheels> hubs_;  // in the body frame
  control::State state_;
};

}  // namespace sim
