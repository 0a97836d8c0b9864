// The model z_{k+1} = F(z_k, u_k) over one sampling time by the classic Runge-Kutta method, and its first-order
// expansion about any (ẑ, û), with analytic derivatives through the four stages:
//
//   F(z, u) ≈ A z + B u + c       A = ∂F/∂z, B = ∂F/∂u at (ẑ, û),  c = F(ẑ, û) − A ẑ − B û
#pragma once

#include "control/vehicle/blended_model.hpp"
#include "control/vehicle/linear_model.hpp"

namespace control {

struct AffineModel {
  LinearModel linear;  // A, B
  State c;
};

class DiscreteModel {
 public:
  // `t_s` [s]: with the paper's parameters, the method is stable at any speed for t_s up to 0.06 s.
  DiscreteModel(const BlendedModel& model, double t_s) : model_(model), t_s_(t_s) {}

  [[nodiscard]] State Step(const State& z, const Input& u) const;
  [[nodiscard]] AffineModel Expand(const State& z, const Input& u) const;

 private:
  BlendedModel model_;
  double t_s_;
};

}  // namespace control
