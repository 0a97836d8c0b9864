// How the solution of an optimisation problem ended.
#pragma once

#include <cstdint>

namespace control {

enum class SolverStatus : std::uint8_t {
  kSolved,            // the KKT residual is below the tolerance
  kInfeasible,        // no input satisfies the hard constraints: proven by a QP's solver
  kIterationLimit,    // stopped before convergence
  kNumericalFailure,  // the factorisation broke down, or the data held a value that is not finite
};

}  // namespace control
