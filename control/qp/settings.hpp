// Accuracy and limits of OcpQpSolver.
#pragma once

namespace control {

struct QpSettings {
  // Largest KKT residual of a solved problem, absolute, in the problem's units. Stationarity and complementarity get an
  // allowance for round-off on top: 1e-12 of the largest multiplier π of the unconstrained optimum, and λ times 1e-12 of
  // its row's value. Where rows are nearly dependent and the round-off of their λ exceeds that, stationarity gets 1e-12
  // of the largest λ, and complementarity is measured relative to its λ.
  double tolerance = 1e-8;
  int max_iterations = 60;   // of the interior point
  int max_working_set = 96;  // rows that the active set may consider; 0: the interior point alone
};

}  // namespace control
