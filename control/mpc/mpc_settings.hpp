// The optimal control problem that the paper's controllers share (eq:nonlinear_MPC, eq:LPV_MPC): horizon, weights and
// bounds. The defaults are those of the paper's tables and text.
#pragma once

#include <numbers>

#include "control/vehicle/types.hpp"

namespace control {

struct MpcSettings {
  int horizon = 8;    // N
  double t_s = 0.05;  // [s]

  // Weights of z − z_ref in the order of z, and of u.
  State Q{10.0, 10.0, 1.0, 1.0, 10.0, 1.0};
  State P{10.0, 10.0, 1.0, 1.0, 10.0, 1.0};
  Input R{0.1, 0.1};

  // Bounds (tab:MPCPar); the bound on ψ is relative to the reference.
  State z_min{-1.0, -600.0, 1.0, -10.0, -std::numbers::pi, -std::numbers::pi / (3.0 * 0.05)};
  State z_max{1500.0, 800.0, 100.0, 10.0, std::numbers::pi, std::numbers::pi / (3.0 * 0.05)};
  Input u_min{-34.0 * std::numbers::pi / 180.0, -6.0};
  Input u_max{34.0 * std::numbers::pi / 180.0, 2.0};
  Input rate_max{25.0 * std::numbers::pi / 180.0, 1.5};  // per step: δ [rad], a [m/s²]

  double obstacle_margin = 0.1;  // enlargement of the obstacles [m]
};

}  // namespace control
