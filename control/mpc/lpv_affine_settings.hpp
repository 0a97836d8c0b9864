// Settings of the problem that lpv-affine and nmpc-affine solve: horizon, weights, bounds, margins.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "control/qp/solver.hpp"
#include "control/vehicle/disturbance.hpp"
#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

struct LpvAffineSettings {
  int horizon = 40;   // N
  double t_s = 0.05;  // [s], at most 0.06: DiscreteModel

  State Q{2.0, 2.0, 1.0, 1.0, 20.0, 100.0};
  double terminal = 5.0;    // P = terminal · Q
  Input R{5.0, 0.2};        // weights of u − u_ref
  Input R_rate{2e3, 10.0};  // weights of Δu

  Input u_min{-34.0 * std::numbers::pi / 180.0, -6.0};
  Input u_max{34.0 * std::numbers::pi / 180.0, 2.0};
  Input rate_max{0.03, 1.0};  // per step: δ [rad], a [m/s²]; 0.6 rad/s, 20 m/s³
  double upsilon_max = 60.0;  // [m/s]

  double mu = 0.7;              // assumed friction coefficient
  double friction_share = 0.9;  // r = friction_share μ g
  Footprint footprint{.front = 1.95, .rear = 2.30, .half_width = 0.9};
  double obstacle_margin = 0.3;  // [m]
  double road_margin = 0.4;      // [m]
  double stop_gap = 2.0;         // gap to an obstacle that cannot be passed [m]

  bool trust_region = true;
  bool adapt_trust_region = true;                    // scale the radii by the accuracy of the last prediction
  Eigen::Vector4d trust_radius{1.0, 0.5, 0.1, 0.1};  // e of υ [m/s], ν [m/s], ψ [rad], δ [rad]
  double trust_weight = 1e2;                         // weight of the squared slack, which is in radii
  // Weights of the slack ε of rows that hold states, [1/m] or [s²/m]: the cost is weight · (ε + ½ ε²), exact while the
  // row's multiplier is below the weight.
  double obstacle_penalty = 4e3;
  double road_penalty = 2e3;
  double state_penalty = 3e2;  // friction and speed
  int iterations = 1;          // QPs per step, as time permits
  int first_iterations = 5;    // QPs in a step without a plan to start from, whatever the time
  double converged = 1e-3;     // iterations end below this change of the scheduling variables [radii]

  // With inputs out of range and a prediction far away, the first QP takes 75 to 83 iterations.
  QpSettings qp{.tolerance = 1e-6, .max_iterations = 120};
};

// The radius r of the friction circle that a plan may use, on a road whose friction coefficient is at most `mu_limit`
// [m/s²].
[[nodiscard]] inline double Grip(const LpvAffineSettings& settings, double mu_limit = kNoLimit) {
  return settings.friction_share * std::min(settings.mu, mu_limit) * kGravity;
}

// Bounds of the inputs where the tyres give at most r = `grip`, of which driving leaves `across` for the bend of the
// reference [m/s²].
[[nodiscard]] inline Input LeastInput(const LpvAffineSettings& settings, double grip) {
  return {settings.u_min[kDelta], std::max(settings.u_min[kAcceleration], -grip)};
}
[[nodiscard]] inline Input MostInput(const LpvAffineSettings& settings, const VehicleParameters& vehicle,
                                     double grip, double across) {
  const double along = DrivenShare(vehicle) * std::sqrt(std::max(grip * grip - across * across, 0.0));
  return {settings.u_max[kDelta], std::min(settings.u_max[kAcceleration], along)};
}

}  // namespace control
