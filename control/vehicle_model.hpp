// The nonlinear bicycle model with linear tyres, ż = f(z, u) (paper, eq:dynamic_model).
//
//   Ẋ = υ cos ψ − ν sin ψ              ν̇ = −ω υ + (2/m) (F_yf cos δ + F_yr)
//   Ẏ = υ sin ψ + ν cos ψ              ψ̇ = ω
//   υ̇ = ω ν + a                        ω̇ = (2/I_z) (l_f F_yf − l_r F_yr)
//
// with F_yf = C_αf (δ − (ν + l_f ω)/υ) and F_yr = C_αr (l_r ω − ν)/υ of one tyre. Needs υ > 0.
#pragma once

#include "control/linear_model.hpp"
#include "control/vehicle_parameters.hpp"

namespace control {

class VehicleModel {
 public:
  explicit VehicleModel(const VehicleParameters& parameters) : parameters_(parameters) {}

  [[nodiscard]] State Derivative(const State& z, const Input& u) const;

  // ∂f/∂z and ∂f/∂u.
  [[nodiscard]] LinearModel Jacobian(const State& z, const Input& u) const;

  // ∇² of λᵀf with respect to [z; u], symmetric.
  using Curvature = Eigen::Matrix<double, kStates + kInputs, kStates + kInputs>;
  [[nodiscard]] Curvature Hessian(const State& z, const Input& u, const State& lambda) const;

 private:
  VehicleParameters parameters_;
};

}  // namespace control
