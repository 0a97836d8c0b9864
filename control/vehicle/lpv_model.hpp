// The LPV embedding of the bicycle, ż = A_c(p) z + B_c(p) u with p = [υ ν δ ψ] (paper, Section LPV Model):
// equal to f(z, u) where p is taken from z and u themselves and υ ≥ kMinUpsilon. The paper's β_f, β_r, γ_f, γ_r
// are 2 C_α/m and 2 l C_α/I_z; its typeset "2C{af}/m" is a slip.
//
// The position's rows use the frozen heading ψ̂, so within one prediction a change of ψ does not move X and Y.
#pragma once

#include "control/vehicle/linear_model.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// p = [υ ν δ ψ]
struct Scheduling {
  double upsilon = 0.0;
  double nu = 0.0;
  double delta = 0.0;
  double psi = 0.0;
};

enum class Discretisation {
  kEuler,  // I + t_s A_c, t_s B_c (paper, eq:dis_LPV): lateral dynamics unstable below 10 m/s at 0.05 s
  kZeroOrderHold,  // exact for constant p and u, at any speed
};

class LpvModel {
 public:
  explicit LpvModel(const VehicleParameters& parameters);

  // A_c(p), B_c(p). υ is taken as at least kMinUpsilon: the tyres' slip is not defined at standstill.
  [[nodiscard]] LinearModel Continuous(const Scheduling& p) const;
  // A(p), B(p) for the sampling time t_s [s].
  [[nodiscard]] LinearModel Discrete(const Scheduling& p, double t_s, Discretisation method) const;

  static constexpr double kMinUpsilon = 0.5;  // [m/s]

 private:
  [[nodiscard]] LinearModel ZeroOrderHold(const Scheduling& p, double t_s) const;

  double beta_f_, beta_r_, gamma_f_, gamma_r_, l_f_, l_r_;
};

}  // namespace control
