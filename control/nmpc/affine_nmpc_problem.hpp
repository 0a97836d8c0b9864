// The problem of lpv_affine_mpc.hpp as a nonlinear program: the cost and constraints are the same, but the model, the
// friction and the position of each body point are exact instead of first-order, and there is no trust region. It is
// solved in affine_nmpc.hpp.
//
//   min   |z_N − z_ref_N|²_P + Σ_{i=1..N-1} |z_i − z_ref_i|²_Q + Σ_{i<N} |u_i − u_ref_i|²_R + |u_i − u_{i−1}|²_R_rate
//         + Σ_soft penalty (ε + ½ ε²)
//   s.t.  for i = 0..N-1
//         0 = z_{i+1} − F(z_i, u_i)                            6 rows   (discrete_model.hpp)
//         |u_i − u_{i−1}| ≤ rate_max, u_{−1} the last applied input   2 rows
//   soft: 0 ≤ υ ≤ υ_max                                        1 row, at i + 1 like all below
//         |υω − a_y| ≤ r, |υω − a_y ± a_i| ≤ √2 r              3 rows
//         lo ≤ normalᵀ (p + R(ψ) fixed) ≤ hi                   one for each BodyRow of tracking_problem.hpp
//         u_min ≤ u_i ≤ u_max                                  bounds of the variables
//
// A soft row is lo ≤ g + ε_lo − ε_hi ≤ hi with ε_lo, ε_hi ≥ 0. At an optimum one of them is 0, since lowering both
// equally keeps the row and lowers the cost: together they are the QP's single ε. The slack of a missing bound is
// fixed at 0.
//
// The variables are x = [u_0 z_1 ε_1 u_1 z_2 ε_2 … u_{N−1} z_N ε_N] with ε_lo, ε_hi of each soft row. The rows of
// step i are consecutive, in the order above.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/mpc/lpv_affine_settings.hpp"
#include "control/mpc/tracking_problem.hpp"
#include "control/nmpc/nonlinear_program.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

class AffineNmpcProblem final : public NonlinearProgram {
 public:
  AffineNmpcProblem(const VehicleParameters& vehicle, const LpvAffineSettings& settings);

  // Sets the problem of this step with the tracking problem's rows, after its BuildConstraints.
  void Set(const TrackingProblem& tracking, const Input& u_previous, const Disturbance& disturbance = {},
           double mu_limit = kNoLimit);

  [[nodiscard]] DiscreteModel ModelWith(const Disturbance& disturbance) const {
    return {BlendedModel(vehicle_, disturbance), settings_.t_s};
  }

  [[nodiscard]] int horizon() const { return settings_.horizon; }
  // Indices in x of u_i (i = 0..N-1), of z_i (i = 1..N) and of ε_lo of soft row `soft` at z_i; ε_hi follows ε_lo.
  [[nodiscard]] int InputAt(int i) const { return step(i).first_variable; }
  [[nodiscard]] int StateAt(int i) const { return step(i - 1).first_variable + kInputs; }
  [[nodiscard]] int SlackAt(int i, int soft) const { return StateAt(i) + kStates + 2 * soft; }
  // Indices in g of the model and rate rows of step i (i = 0..N-1), and of soft row `soft` at z_i (i = 1..N).
  [[nodiscard]] int RowAt(int i) const { return step(i).first_row; }
  [[nodiscard]] int SoftRowAt(int i, int soft) const { return RowAt(i - 1) + kStates + kInputs + soft; }
  [[nodiscard]] int SoftRows(int i) const;
  [[nodiscard]] Constraint SoftConstraint(int i, int soft) const;

  [[nodiscard]] int variables() const override { return variables_; }
  [[nodiscard]] int rows() const override { return rows_; }
  [[nodiscard]] const Bounds& variable_bounds() const override { return variable_bounds_; }
  [[nodiscard]] const Bounds& row_bounds() const override { return row_bounds_; }
  [[nodiscard]] const std::vector<Entry>& jacobian_pattern() const override { return jacobian_pattern_; }
  [[nodiscard]] const std::vector<Entry>& hessian_pattern() const override { return hessian_pattern_; }
  [[nodiscard]] double Cost(std::span<const double> x) const override;
  void Gradient(std::span<const double> x, std::span<double> gradient) const override;
  void Rows(std::span<const double> x, std::span<double> g) const override;
  void Jacobian(std::span<const double> x, std::span<double> values) const override;
  // The model's part comes from differences of the exact gradient: it affects only the solver's steps, not the point
  // to which they converge.
  void Hessian(std::span<const double> x, double sigma, std::span<const double> lambda,
               std::span<double> values) const override;

  [[nodiscard]] State StateOf(std::span<const double> x, int i) const;  // i = 0..N
  [[nodiscard]] Input InputOf(std::span<const double> x, int i) const;  // i = -1..N-1
  // x of a trajectory, with the slacks that it needs.
  [[nodiscard]] std::vector<double> PointOf(std::span<const State> z, std::span<const Input> u) const;
  // ε of a soft row at z_i.
  [[nodiscard]] double Slack(std::span<const double> x, int i, int soft) const;
  [[nodiscard]] double Penalty(int i, int soft) const;

 private:
  // Soft rows of a step other than those of the body: the speed, then the friction.
  static constexpr int kSpeedRow = 0;
  static constexpr std::array kFrictionSigns{0, 1, -1};  // signs of a in the friction rows
  static constexpr int kBodyRow = 1 + static_cast<int>(kFrictionSigns.size());

  // Second derivatives with respect to [z; u].
  using Curvature = Eigen::Matrix<double, kStates + kInputs, kStates + kInputs>;
  struct Step {
    int first_variable = 0;
    int first_row = 0;
    std::vector<BodyRow> body;  // rows of the body at z_{i+1}
    double speed_limit = 0.0;   // at z_{i+1} [m/s]
  };
  // Value of a soft row, and its derivatives with respect to z_i and a_{i−1}.
  struct Row {
    double value = 0.0;
    State by_z = State::Zero();
    double by_a = 0.0;
  };

  [[nodiscard]] const Step& step(int i) const { return steps_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const BodyRow& Body(int i, int soft) const;
  [[nodiscard]] Row SoftRow(int i, int soft, const State& z, const Input& u) const;
  [[nodiscard]] std::array<double, 2> SoftBounds(int i, int soft) const;
  [[nodiscard]] State Weights(int i) const;
  [[nodiscard]] Curvature ModelCurvature(const State& z, const Input& u, const State& lambda) const;
  void SetBounds();
  void MakePatterns();
  // Calls visit(row, column, value) for every entry of the pattern, in the same order for every x.
  template <typename Visit>
  void VisitJacobian(std::span<const double> x, const Visit& visit) const;
  template <typename Visit>
  void VisitHessian(std::span<const double> x, double sigma, std::span<const double> lambda,
                    const Visit& visit) const;

  VehicleParameters vehicle_;
  LpvAffineSettings settings_;
  DiscreteModel model_;  // with the disturbance of the step
  double a_y_ = 0.0;     // the disturbance's [m/s²]
  double grip_ = 0.0;    // r of the step [m/s²]
  State z_0_ = State::Zero();
  Input u_previous_ = Input::Zero();
  std::vector<State> z_ref_;
  std::vector<Input> u_ref_;
  std::vector<Step> steps_;
  int variables_ = 0, rows_ = 0;
  Bounds variable_bounds_, row_bounds_;
  std::vector<Entry> jacobian_pattern_, hessian_pattern_;
};

}  // namespace control
