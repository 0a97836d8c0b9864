// How the solution of an optimisation problem ended, and what may end it early.
#pragma once

#include <cstdint>
#include <functional>

namespace control {

enum class SolverStatus : std::uint8_t {
  kSolved,            // the KKT residual is below the tolerance
  kInfeasible,        // no input satisfies the hard constraints: proven by a QP's solver
  kIterationLimit,    // stopped before convergence
  kNumericalFailure,  // the factorisation broke down, or the data held a value that is not finite
};

// Asked before each iteration; false ends the solve. The caller owns the clock.
using TimeLeft = std::function<bool()>;

}  // namespace control
