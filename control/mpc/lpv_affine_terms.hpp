// What LpvAffineMpc, its rows and AffineNmpc have in common.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "control/vehicle/types.hpp"

namespace control::lpv_affine {

inline constexpr double kLeastRelaxation = 1e-3;  // below it a slack is the solver's inaccuracy
inline constexpr int kU = kStates;                // index of u_{k−1} in the QP's state
// The scheduled quantities in the order of the trust radii: three states, then δ.
inline constexpr std::array kScheduledStates{kUpsilon, kNu, kPsi};
inline constexpr std::size_t kScheduledDelta = kScheduledStates.size();

inline std::size_t Index(int i) {
  return static_cast<std::size_t>(i);
}

// The vector that begins at x[i].
template <typename Vector>
Eigen::Map<const Vector> At(std::span<const double> x, int i) {
  return Eigen::Map<const Vector>(x.subspan(Index(i), Vector::SizeAtCompileTime).data());
}

}  // namespace control::lpv_affine
