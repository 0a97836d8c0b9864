// The side forces of the axles, as lateral accelerations: the force of an axle divided by the mass that rests on it,
// so that an axle slides at about μ g whatever its load.
#pragma once

#include "control/vehicle/disturbance.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

enum Axle : int { kFront, kRear };
using Axles = Eigen::Vector2d;  // [m/s²]

// What linear tyres give at the slip of this state, υ > 0.
[[nodiscard]] inline Axles LinearDemand(const VehicleParameters& v, const State& z, const Input& u,
                                        const Disturbance& disturbance) {
  const double wheelbase = v.l_f + v.l_r;
  const double front = u[kDelta] + disturbance.delta_0 - (z[kNu] + v.l_f * z[kOmega]) / z[kUpsilon];
  const double rear = (v.l_r * z[kOmega] - z[kNu]) / z[kUpsilon];
  const double scale = 2.0 * disturbance.stiffness_factor * wheelbase / v.m;
  return {scale * v.C_alpha_f * front / v.l_r, scale * v.C_alpha_r * rear / v.l_f};
}

}  // namespace control
