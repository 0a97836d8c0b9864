// Operations on the rows of an OcpQp, both general rows and bounds of a single variable.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "control/qp/problem.hpp"

namespace control {

namespace detail {

// Calls visit(row, its stage, its index there) for every row.
template <typename Qp, typename Visit>
void ForEachRow(const Qp& qp, Visit&& visit) {
  for (std::size_t i = 0; i < qp.stages.size(); ++i) {
    const auto& stage = qp.stages[i];
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) visit(stage.rows[j], i, j);
  }
}

// Returns C x + D u.
template <typename Row, typename VectorX, typename VectorU>
double RowValue(const Row& row, const VectorX& x, const VectorU& u) {
  if (row.unit >= VectorX::RowsAtCompileTime) return u[row.unit - VectorX::RowsAtCompileTime];
  if (row.unit >= 0) return x[row.unit];
  return row.C.dot(x) + row.D.dot(u);
}

// The distance by which a value is outside its bounds; negative inside.
inline double Violation(double lo, double hi, double value) {
  return std::max(lo - value, value - hi);
}

// [gradient_x; gradient_u] += factor [C; D].
template <typename Row, typename VectorX, typename VectorU>
void AddRowGradient(const Row& row, double factor, VectorX& gradient_x, VectorU& gradient_u) {
  if (row.unit >= VectorX::RowsAtCompileTime) {
    gradient_u[row.unit - VectorX::RowsAtCompileTime] += factor;
  } else if (row.unit >= 0) {
    gradient_x[row.unit] += factor;
  } else {
    gradient_x += factor * row.C;
    gradient_u += factor * row.D;
  }
}

// The slack of a row with multiplier λ = λ_hi − λ_lo and the given violation.
template <typename Row>
double SlackOf(const Row& row, double lambda, double violation) {
  if (!row.soft()) return 0.0;
  if (row.rho > 0.0) return std::max(0.0, (std::abs(lambda) - row.sigma) / row.rho);
  return std::abs(lambda) < row.sigma ? 0.0 : std::max(0.0, violation);
}

}  // namespace detail

}  // namespace control
