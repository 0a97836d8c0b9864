// Parameters of the vehicle's single-track model (paper, tab:VarPar).
#pragma once

namespace control {

inline constexpr double kGravity = 9.81;  // [m/s²]

struct VehicleParameters {
  double C_alpha_f = 156e3;  // cornering stiffness of one front tyre [N/rad]
  double C_alpha_r = 193e3;  // cornering stiffness of one rear tyre [N/rad]
  double l_f = 1.04;         // centre of gravity to front axle [m]
  double l_r = 1.40;         // centre of gravity to rear axle [m]
  double I_z = 2937.0;       // yaw inertia [kg m²]
  double m = 1919.0;         // mass [kg]
};

}  // namespace control
