// Steady cornering of the single-track model with linear tyres, down to standstill, where the dynamic model does not
// hold:
//
//   δ = κ (L + K υ²)          L = l_f + l_r,  K = m/(2L) (l_r/C_αf − l_f/C_αr)       understeer gradient
//   ν/υ = κ (l_r − m l_f υ²/(2 C_αr L))
//
// A lateral acceleration a_y by bank or wind takes the place of a part of κ υ²; it adds −K a_y to δ and
// m l_f/(2 C_αr L) a_y to ν/υ.
#pragma once

#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// K [rad s²/m].
[[nodiscard]] inline double UndersteerGradient(const VehicleParameters& v) {
  return v.m / (2.0 * (v.l_f + v.l_r)) * (v.l_r / v.C_alpha_f - v.l_f / v.C_alpha_r);
}

// δ/κ [rad m].
[[nodiscard]] inline double SteeringPerCurvature(const VehicleParameters& v, double speed) {
  return v.l_f + v.l_r + UndersteerGradient(v) * speed * speed;
}

// (ν/υ)/κ: the sideslip angle per unit of curvature [rad m].
[[nodiscard]] inline double SideslipPerCurvature(const VehicleParameters& v, double speed) {
  return v.l_r - v.m * v.l_f * speed * speed / (2.0 * v.C_alpha_r * (v.l_f + v.l_r));
}

// (ν/υ)/a_y: the sideslip angle per lateral acceleration that is not the tyres' [rad s²/m].
[[nodiscard]] inline double SideslipPerAcceleration(const VehicleParameters& v) {
  return v.m * v.l_f / (2.0 * v.C_alpha_r * (v.l_f + v.l_r));
}

}  // namespace control
