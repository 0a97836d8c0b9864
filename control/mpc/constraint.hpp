// The name of a constraint in a controller's problem, and the amount by which it cannot be met.
#pragma once

#include <cstdint>

namespace control {

enum class ConstraintKind : std::uint8_t {
  kModel,     // z_{i+1} follows from z_i and u_i; index of the state
  kInput,     // u_min ≤ u_i ≤ u_max; index of the input
  kRate,      // |u_i − u_{i−1}|; index of the input
  kState,     // z_min ≤ z_i ≤ z_max; index of the state
  kRoad,      // road bounds at z_i
  kObstacle,  // obstacle at z_i; id of the obstacle
  kFriction,  // acceleration at z_i; 0 lateral, 1 lateral and longitudinal
  kTrust,     // trust region at z_i; index of the state, or kStates + index of the input
};

struct Constraint {
  ConstraintKind kind = ConstraintKind::kModel;
  int index = 0;
  int step = 0;  // i, 0..N
};

// A slack below this is attributed to the solver's inaccuracy.
inline constexpr double kLeastRelaxation = 1e-3;

struct ConstraintViolation {
  Constraint constraint;
  // > 0, in the unit of the constrained quantity, [m] for road and obstacle. Amounts are compared regardless of unit.
  double amount = 0.0;
};

}  // namespace control
