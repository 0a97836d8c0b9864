// What the solver does with each row of an OcpQp, whichever way the row is written.
#pragma once

#include <algorithm>
#include <cstddef>

#include "control/qp/ocp_qp.hpp"

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

// C x + D u.
template <typename Row, typename VectorX, typename VectorU>
double RowValue(const Row& row, const VectorX& x, const VectorU& u) {
  if (row.unit >= VectorX::RowsAtCompileTime) return u[row.unit - VectorX::RowsAtCompileTime];
  if (row.unit >= 0) return x[row.unit];
  return row.C.dot(x) + row.D.dot(u);
}

// By how much a value lies outside its bounds; negative inside.
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

}  // namespace detail

}  // namespace control
