// The nonlinear program of the paper's NMPC (eq:nonlinear_MPC), with exact sparse derivatives, solved in nmpc.hpp.
//
//   min   |z_N − z_ref_N|²_P + Σ_{i=1..N-1} |z_i − z_ref_i|²_Q + Σ_{i<N} |u_i|²_R
//   s.t.  for i = 0..N-1
//         0 = z_{i+1} − z_i − t_s f(z_i, u_i)                        6 rows   (eq:NMPC_model)
//         |u_i − u_{i−1}| ≤ rate_max, u_{−1} the last applied input  2 rows
//         right ≤ n_{i+1}ᵀ (X, Y)_{i+1} ≤ left                       1 row    (eq:NMPC_road_cons)
//         ((X, Y)_{i+1} in the obstacle's axes, divided by its semi-axes)² ≥ 1     1 row each   (eq:NMPC_obs_cons)
//         u_min ≤ u_i ≤ u_max, z_min ≤ z_{i+1} ≤ z_max               bounds of the variables
//
// n is the road's left normal at the reference, from which the road's edges are measured. Obstacles are enlarged by
// the margin. The variables are x = [u_0 z_1 u_1 z_2 … u_{N−1} z_N], 8 per step; z_0 is given. The rows of step i are
// consecutive, in the order above.
#pragma once

#include <span>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/mpc/mpc_settings.hpp"
#include "control/mpc/tracking_controller.hpp"
#include "control/nmpc/nonlinear_program.hpp"
#include "control/vehicle/single_track.hpp"

namespace control {

class NmpcProblem final : public NonlinearProgram {
 public:
  NmpcProblem(const VehicleParameters& vehicle, const MpcSettings& settings);

  // Sets the problem of this step. Its size depends only on the number of obstacles.
  void Set(const TrackingInput& input);

  static constexpr int kStepVariables = kInputs + kStates;
  [[nodiscard]] int horizon() const { return settings_.horizon; }
  [[nodiscard]] int variables() const override { return settings_.horizon * kStepVariables; }
  [[nodiscard]] int rows() const override { return settings_.horizon * StepRows(); }
  // Indices in x of u_i (i = 0..N-1) and z_i (i = 1..N).
  [[nodiscard]] static constexpr int InputAt(int i) { return i * kStepVariables; }
  [[nodiscard]] static constexpr int StateAt(int i) { return (i - 1) * kStepVariables + kInputs; }

  [[nodiscard]] const Bounds& variable_bounds() const override { return variable_bounds_; }
  [[nodiscard]] const Bounds& row_bounds() const override { return row_bounds_; }
  [[nodiscard]] const std::vector<Entry>& jacobian_pattern() const override { return jacobian_pattern_; }
  [[nodiscard]] const std::vector<Entry>& hessian_pattern() const override { return hessian_pattern_; }
  [[nodiscard]] double Cost(std::span<const double> x) const override;
  void Gradient(std::span<const double> x, std::span<double> gradient) const override;
  void Rows(std::span<const double> x, std::span<double> g) const override;
  void Jacobian(std::span<const double> x, std::span<double> values) const override;
  void Hessian(std::span<const double> x, double sigma, std::span<const double> lambda,
               std::span<double> values) const override;

  [[nodiscard]] State StateOf(std::span<const double> x, int i) const;  // i = 0..N
  [[nodiscard]] Input InputOf(std::span<const double> x, int i) const;  // i = 0..N-1

  // z_{i+1} from z_i and u_i by forward Euler.
  [[nodiscard]] State Next(const State& z, const Input& u) const;
  // The inputs of x with the states that they lead to.
  [[nodiscard]] std::vector<double> Driven(std::span<const double> x) const;
  // The constraint that x violates most; the depth in an ellipse is measured as in a circle of its smaller semi-axis.
  [[nodiscard]] ConstraintViolation LargestViolation(std::span<const double> x) const;

 private:
  struct Ellipse {
    Eigen::Vector2d centre;
    Eigen::Matrix2d M;  // (p − centre)ᵀ M (p − centre) = 1 on the edge
    double smaller_semi_axis;
    int id;
  };

  [[nodiscard]] int StepRows() const { return kStates + kInputs + 1 + static_cast<int>(ellipses_.size()); }
  [[nodiscard]] Constraint RowConstraint(int row) const;
  [[nodiscard]] const State& Weights(int i) const { return i < horizon() ? settings_.Q : settings_.P; }
  [[nodiscard]] Eigen::Vector2d Normal(int i) const;
  void MakePatterns();
  // Calls visit(row, column, value) for every entry of the pattern, in the same order for every x.
  template <typename Visit>
  void VisitJacobian(std::span<const double> x, const Visit& visit) const;
  template <typename Visit>
  void VisitHessian(std::span<const double> x, double sigma, std::span<const double> lambda,
                    const Visit& visit) const;

  MpcSettings settings_;
  SingleTrackModel model_;
  State z_0_ = State::Zero();
  std::vector<State> reference_;
  std::vector<Ellipse> ellipses_;
  Bounds variable_bounds_, row_bounds_;
  std::vector<Entry> jacobian_pattern_, hessian_pattern_;
};

}  // namespace control
