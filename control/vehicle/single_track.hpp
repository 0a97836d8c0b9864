// The nonlinear bicycle model with linear tyres, ż = f(z, u) (paper, eq:dynamic_model).
//
//   Ẋ = υ cos ψ − ν sin ψ              ν̇ = −ω υ + (2/m) (F_yf cos δ + F_yr)
//   Ẏ = υ sin ψ + ν cos ψ              ψ̇ = ω
//   υ̇ = ω ν + a                        ω̇ = (2/I_z) (l_f F_yf − l_r F_yr)
//
// with F_yf = C_αf (δ − (ν + l_f ω)/υ) and F_yr = C_αr (l_r ω − ν)/υ for one tyre each. The model requires υ > 0.
#pragma once

#include <cmath>

#include "control/vehicle/linear_model.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// Sines and cosines of ψ and δ. They dominate the model's cost, so repeated evaluations share them.
struct Angles {
  double sin_psi, cos_psi, sin_delta, cos_delta;

  Angles(const State& z, const Input& u) : sin_delta(std::sin(u[kDelta])), cos_delta(std::cos(u[kDelta])) {
    Turn(z);
  }
  void Turn(const State& z) {  // to another ψ
    sin_psi = std::sin(z[kPsi]);
    cos_psi = std::cos(z[kPsi]);
  }
};

class SingleTrackModel {
 public:
  explicit SingleTrackModel(const VehicleParameters& parameters) : parameters_(parameters) {}

  [[nodiscard]] State Derivative(const State& z, const Input& u) const { return Derivative(z, u, {z, u}); }
  [[nodiscard]] State Derivative(const State& z, const Input& u, const Angles& angles) const;

  // ∂f/∂z and ∂f/∂u.
  [[nodiscard]] LinearModel Jacobian(const State& z, const Input& u) const { return Jacobian(z, u, {z, u}); }
  [[nodiscard]] LinearModel Jacobian(const State& z, const Input& u, const Angles& angles) const;

  // ∇² of λᵀf with respect to [z; u], symmetric.
  using Curvature = Eigen::Matrix<double, kStates + kInputs, kStates + kInputs>;
  [[nodiscard]] Curvature Hessian(const State& z, const Input& u, const State& lambda) const;

 private:
  VehicleParameters parameters_;
};

}  // namespace control
