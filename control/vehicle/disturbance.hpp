// What acts on the vehicle besides its inputs, as the single-track model sees it. The default is no disturbance.
#pragma once

#include <limits>

#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// No bound of the friction coefficient.
inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Disturbance {
  double delta_0 = 0.0;           // steering offset: the front wheels stand at δ + δ_0 [rad]
  double a_y = 0.0;               // lateral acceleration by bank and side wind, left positive [m/s²]
  double a_x = 0.0;               // longitudinal acceleration by slope and drag [m/s²]
  double stiffness_factor = 1.0;  // factor of the cornering stiffness of all tyres, > 0
};

// The input that the undisturbed vehicle would need for the same effect.
[[nodiscard]] inline Input Acting(const Input& u, const Disturbance& disturbance) {
  return u + Input(disturbance.delta_0, disturbance.a_x);
}

// The vehicle with the disturbed cornering stiffness.
[[nodiscard]] inline VehicleParameters Disturbed(VehicleParameters vehicle, const Disturbance& disturbance) {
  vehicle.C_alpha_f *= disturbance.stiffness_factor;
  vehicle.C_alpha_r *= disturbance.stiffness_factor;
  return vehicle;
}

}  // namespace control
