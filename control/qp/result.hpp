// The outcome of OcpQpSolver::Solve.
#pragma once

#include <cstdint>

#include "control/qp/status.hpp"

namespace control {

enum class QpMethod : std::uint8_t { kUnconstrained, kActiveSet, kInteriorPoint };

struct QpResult {
  SolverStatus status = SolverStatus::kNumericalFailure;
  QpMethod method = QpMethod::kUnconstrained;  // method that gave the answer
  int iterations = 0;         // changes of the active set, or iterations of the interior point
  double kkt_residual = 0.0;  // largest KKT residual of a solved problem
  bool feasible = false;      // the solution satisfies the dynamics and the hard rows

  // True if the solution is useful as a warm start: an unconstrained optimum has no multipliers.
  [[nodiscard]] bool CanWarmStart() const {
    return status == SolverStatus::kSolved && method != QpMethod::kUnconstrained;
  }
};

}  // namespace control
