#include "control/mpc/row_writer.hpp"

namespace control {

void RowWriter::Clear() {
  for (auto& stage : qp_->stages) stage.ClearRows();
  fits_ = true;
}

void RowWriter::AddStateBound(const Constraint& constraint, int index, double lo, double hi,
                              const Softness& softness) {
  auto& stage = qp_->stages[Index(constraint.step)];
  Name(constraint, stage.AddStateBound(index, lo, hi, softness.rho, softness.sigma));
}

void RowWriter::AddInputBound(const Constraint& constraint, int index, double lo, double hi,
                              const Softness& softness) {
  auto& stage = qp_->stages[Index(constraint.step)];
  Name(constraint, stage.AddInputBound(index, lo, hi, softness.rho, softness.sigma));
}

void RowWriter::AddRow(const Constraint& constraint, const QpState& C, const Input& D, double lo, double hi,
                       const Softness& softness) {
  auto& stage = qp_->stages[Index(constraint.step)];
  Name(constraint, stage.AddRow(C, D, lo, hi, softness.rho, softness.sigma));
}

void RowWriter::Name(const Constraint& constraint, bool added) {
  fits_ &= added;
  if (!added) return;
  const int rows = qp_->stages[Index(constraint.step)].row_count;
  constraints_[Index(constraint.step)][Index(rows - 1)] = constraint;
}

}  // namespace control
