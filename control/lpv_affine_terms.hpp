// What the parts of LpvAffineMpc have in common.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

#include "control/lpv_affine_mpc.hpp"
#include "control/types.hpp"

namespace control::lpv_affine {

inline constexpr double kGravity = 9.81;          // [m/s²]
inline constexpr double kLeastRelaxation = 1e-3;  // below it a slack is the solver's inaccuracy
inline constexpr int kU = kStates;                // index of u_{k−1} in the QP's state
// The scheduled quantities in the order of the trust radii: three states, then δ.
inline constexpr std::array kScheduledStates{kUpsilon, kNu, kPsi};
inline constexpr std::size_t kScheduledDelta = kScheduledStates.size();

inline std::size_t Index(int i) {
  return static_cast<std::size_t>(i);
}

// Radius of the friction circle [m/s²].
inline double Grip(const LpvAffineSettings& settings) {
  return settings.friction_share * settings.mu * kGravity;
}

}  // namespace control::lpv_affine
