// Parameters of the vehicle's single-track model (paper, tab:VarPar).
#pragma once

#include <cstdint>

namespace control {

inline constexpr double kGravity = 9.81;  // [m/s²]

// The axle whose tyres drive the vehicle; those of both axles brake.
enum class DrivenAxle : std::uint8_t { kBoth, kFront, kRear };

struct VehicleParameters {
  double C_alpha_f = 156e3;  // cornering stiffness of one front tyre [N/rad]
  double C_alpha_r = 193e3;  // cornering stiffness of one rear tyre [N/rad]
  double l_f = 1.04;         // centre of gravity to front axle [m]
  double l_r = 1.40;         // centre of gravity to rear axle [m]
  double I_z = 2937.0;       // yaw inertia [kg m²]
  double m = 1919.0;         // mass [kg]
  DrivenAxle driven = DrivenAxle::kBoth;
};

// The share of the weight that rests on the driven axle.
[[nodiscard]] constexpr double DrivenShare(const VehicleParameters& v) {
  if (v.driven == DrivenAxle::kBoth) return 1.0;
  return (v.driven == DrivenAxle::kFront ? v.l_r : v.l_f) / (v.l_f + v.l_r);
}

// The longitudinal force of the tyres that give most of it, divided by the mass that rests on them, for an acceleration
// `a` of the vehicle [m/s²].
[[nodiscard]] constexpr double TyreDemand(const VehicleParameters& v, double a) {
  return a > 0.0 ? a / DrivenShare(v) : a;
}

}  // namespace control
