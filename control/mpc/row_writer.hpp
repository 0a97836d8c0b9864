// Adds rows to a VehicleQp and records which constraint each row stands for.
#pragma once

#include <array>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/mpc/vehicle_qp.hpp"
#include "control/qp/problem.hpp"

namespace control {

// Weights of a row's slack ε: ½ ρ ε² + σ ε.
struct Softness {
  double rho = -1.0;  // negative: the row is hard
  double sigma = 0.0;
};

class RowWriter {
 public:
  // `qp` must outlive the writer.
  explicit RowWriter(VehicleQp& qp) : qp_(&qp), constraints_(qp.stages.size()) {}
  RowWriter(const RowWriter&) = delete;
  RowWriter& operator=(const RowWriter&) = delete;

  // Removes all rows.
  void Clear() {
    for (auto& stage : qp_->stages) stage.ClearRows();
    fits_ = true;
  }
  // Add lo ≤ x[index] ≤ hi, lo ≤ u[index] ≤ hi, and lo ≤ Cᵀx + Dᵀu ≤ hi at stage constraint.step.
  void AddStateBound(const Constraint& constraint, int index, double lo, double hi,
                     const Softness& softness = {}) {
    Name(constraint, StageOf(constraint).AddStateBound(index, lo, hi, softness.rho, softness.sigma));
  }
  void AddInputBound(const Constraint& constraint, int index, double lo, double hi,
                     const Softness& softness = {}) {
    Name(constraint, StageOf(constraint).AddInputBound(index, lo, hi, softness.rho, softness.sigma));
  }
  void AddRow(const Constraint& constraint, const QpState& C, const Input& D, double lo, double hi,
              const Softness& softness = {}) {
    Name(constraint, StageOf(constraint).AddRow(C, D, lo, hi, softness.rho, softness.sigma));
  }

  // False if a stage lacked room for a row since Clear. The QP is then incomplete and must not be used.
  [[nodiscard]] bool fits() const { return fits_; }
  [[nodiscard]] const Constraint& constraint(std::size_t stage, std::size_t row) const {
    return constraints_[stage][row];
  }

 private:
  [[nodiscard]] OcpQpStage<kStates + kInputs, kInputs>& StageOf(const Constraint& constraint) {
    return qp_->stages[Index(constraint.step)];
  }
  void Name(const Constraint& constraint, bool added) {
    fits_ &= added;
    if (!added) return;
    constraints_[Index(constraint.step)][Index(StageOf(constraint).row_count - 1)] = constraint;
  }

  VehicleQp* qp_;
  std::vector<std::array<Constraint, kMaxRows>> constraints_;
  bool fits_ = true;
};

}  // namespace control
