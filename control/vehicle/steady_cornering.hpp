// Steady cornering of the single-track model with linear tyres, down to standstill, where the dynamic model does not
// hold:
//
//   δ = κ (L + K υ²)          L = l_f + l_r,  K = m/(2L) (l_r/C_αf − l_f/C_αr)       understeer gradient
//   ν/υ = κ (l_r − m l_f υ²/(2 C_αr L))
#pragma once

#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// δ/κ [rad m].
[[nodiscard]] inline double SteeringPerCurvature(const VehicleParameters& v, double speed) {
  const double wheelbase = v.l_f + v.l_r;
  const double understeer = v.m / (2.0 * wheelbase) * (v.l_r / v.C_alpha_f - v.l_f / v.C_alpha_r);
  return wheelbase + understeer * speed * speed;
}

// (ν/υ)/κ: the sideslip angle per unit of curvature [rad m].
[[nodiscard]] inline double SideslipPerCurvature(const VehicleParameters& v, double speed) {
  return v.l_r - v.m * v.l_f * speed * speed / (2.0 * v.C_alpha_r * (v.l_f + v.l_r));
}

}  // namespace control
