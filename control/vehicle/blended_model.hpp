// The vehicle at any speed down to standstill, ż = f(z, u): the dynamic model (single_track.hpp) at high speed and
// the kinematic one at low speed, where slip angles have no meaning and their dynamics are too fast for any sampling
// time. Both share Ẋ, Ẏ, υ̇, ψ̇; between υ_1 and υ_2 the other derivatives are blended smoothly:
//
//   [ν̇ ω̇] = w [ν̇ ω̇]_dynamic + (1 − w) [ν̇ ω̇]_kinematic     w = 3 s² − 2 s³, s = (υ − υ_1)/(υ_2 − υ_1) within 0..1
//
//   ω̇_kinematic = (υ tan δ / (l_f + l_r) − ω) / τ             towards rolling without slip
//   ν̇_kinematic = (l_r υ tan δ / (l_f + l_r) − ν) / τ
//
// A disturbance replaces δ by δ + δ_0, a by a + a_x and the cornering stiffness C_α by c C_α, and adds a_y to
// ν̇_dynamic. Without one, the arithmetic is the same to the bit.
#pragma once

#include "control/vehicle/disturbance.hpp"
#include "control/vehicle/linear_model.hpp"
#include "control/vehicle/single_track.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

class BlendedModel {
 public:
  static constexpr double kUpsilon1 = 4.0;  // kinematic up to this speed [m/s]
  static constexpr double kUpsilon2 = 8.0;  // dynamic from this speed on [m/s]
  static constexpr double kTau = 0.1;       // [s]

  explicit BlendedModel(const VehicleParameters& parameters, const Disturbance& disturbance = {});

  [[nodiscard]] State Derivative(const State& z, const Input& u) const {
    return Derivative(z, u, AnglesAt(z, u));
  }
  [[nodiscard]] State Derivative(const State& z, const Input& u, const Angles& angles) const;
  // ∂f/∂z and ∂f/∂u.
  [[nodiscard]] LinearModel Jacobian(const State& z, const Input& u) const {
    return Linearise(z, u, AnglesAt(z, u)).jacobian;
  }

  // Angles of the vehicle and of its disturbed front wheels.
  [[nodiscard]] Angles AnglesAt(const State& z, const Input& u) const { return {z, Acting(u, disturbance_)}; }

  struct Linearisation {
    State f;
    LinearModel jacobian;
  };
  [[nodiscard]] Linearisation Linearise(const State& z, const Input& u, const Angles& angles) const;

 private:
  // The dynamic model's derivative, at a υ for which it holds.
  [[nodiscard]] State Dynamic(const State& fast, const Input& u, const Angles& angles) const;
  [[nodiscard]] State Blend(const State& z, const Angles& angles, const State& dynamic, double w) const;

  SingleTrackModel dynamic_;
  double wheelbase_, l_r_;
  Disturbance disturbance_;
};

}  // namespace control
