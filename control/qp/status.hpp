// The outcome of an optimisation, and the callback that may end it early.
#pragma once

#include <cstdint>
#include <functional>

namespace control {

enum class SolverStatus : std::uint8_t {
  kSolved,            // the KKT residual is below the tolerance
  kInfeasible,        // no input satisfies the hard constraints (a proof, if from the QP solver)
  kIterationLimit,    // stopped before convergence
  kNumericalFailure,  // the factorisation broke down, or the data are not finite
};

// Called before each iteration; false ends the solve. The caller owns the clock.
using TimeLeft = std::function<bool()>;

}  // namespace control
