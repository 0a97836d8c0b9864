// Accuracy and limits of OcpQpSolver.
#pragma once

namespace control {

struct QpSettings {
  // Largest KKT residual of a solved problem, absolute, in the problem's units. Stationarity and complementarity have
  // an extra allowance for round-off: 1e-12 of the largest multiplier π of the unconstrained optimum, and λ times 1e-12
  // of its row's value. If rows are nearly dependent and the round-off of their λ exceeds that, stationarity is allowed
  // 1e-12 of the largest λ, and complementarity is measured relative to λ.
  double tolerance = 1e-8;
  int max_iterations = 60;   // most iterations of the interior-point method
  int max_working_set = 96;  // most rows of the active set; 0: only the interior point is used
};

}  // namespace control
