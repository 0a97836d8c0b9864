// The LPVMPC with the model that is first-order exact: the paper's scheduling by the last plan (eq:LPV_MPC,
// alg:LPVMPC) and its trust region, but about the predicted trajectory (ẑ, û)
//
//   z_{i+1} = F(ẑ_i, û_i) + A_i (z_i − ẑ_i) + B_i (u_i − û_i)        A = ∂F/∂z, B = ∂F/∂u   (affine_model.hpp)
//
// so that a change of heading moves the vehicle inside the QP, too, and one QP is one iteration of sequential quadratic
// programming. It knows the course itself and needs no reference window: progress_reference.hpp.
//
//   min   Σ |z_i − z_ref_i|²_Q + |u_i − u_ref_i|²_R + |Δu_i|²_R_rate + penalties
//   hard  |Δu_i| ≤ rate_max, u_min ≤ u_i ≤ u_max
//   soft  0 ≤ υ ≤ υ_max;   road and obstacles with the vehicle's footprint;
//         |υω| ≤ r, |υω ± a| ≤ √2 r: an octagon about the friction circle of radius r, but for the bounds of a itself;
//         |p_i − p̂_i| ≤ e for p = [υ ν ψ δ]: the trust region
//
// Q, R are weights of deviations from the reference (reference input δ_ref, a_ref included). The QP's state is
// x = [z − z_ref; u_{k−1} − u_ref], its input Δu: every bound of an input is then one of a single variable.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "control/affine_model.hpp"
#include "control/controller.hpp"
#include "control/course.hpp"
#include "control/footprint.hpp"
#include "control/halfspace.hpp"
#include "control/ocp_qp_solver.hpp"
#include "control/passing.hpp"
#include "control/progress_reference.hpp"
#include "control/vehicle_parameters.hpp"

namespace control {

struct LpvAffineSettings {
  int horizon = 40;   // N
  double t_s = 0.05;  // [s], at most 0.06: DiscreteModel

  State Q{2.0, 2.0, 1.0, 1.0, 20.0, 100.0};
  double terminal = 5.0;    // P = terminal Q
  Input R{5.0, 0.2};        // of u − u_ref
  Input R_rate{2e3, 10.0};  // of Δu

  Input u_min{-0.5, -6.0};
  Input u_max{0.5, 2.0};
  Input rate_max{0.03, 1.0};  // per step: 0.6 rad/s, 20 m/s³
  double upsilon_max = 60.0;  // [m/s]

  double mu = 0.7;              // friction coefficient that is reckoned with
  double friction_share = 0.8;  // r = friction_share μ g
  Footprint footprint{.front = 1.95, .rear = 2.30, .half_width = 0.9};
  double obstacle_margin = 0.3;  // [m]
  double road_margin = 0.2;      // [m]
  double stop_gap = 2.0;         // before an obstacle that cannot be passed [m]

  bool trust_region = true;
  bool adapt_trust_region = true;  // its radii are scaled by how well the last prediction came true
  Eigen::Vector4d trust_radius{1.0, 0.5, 0.1, 0.1};  // e of υ [m/s], ν [m/s], ψ [rad], δ [rad]
  double trust_weight = 1e2;                         // of the slack, in radii²
  // Of the slack ε of rows that hold states, [1/m] or [s²/m]: penalty (ε + ½ ε²), exact while the row's multiplier is
  // below it.
  double obstacle_penalty = 4e3;
  double road_penalty = 2e3;
  double state_penalty = 3e2;  // friction and speed
  int iterations = 1;          // QPs in one step, while there is time
  int first_iterations = 5;    // in a first step, which has no plan to start from, time or not
  double converged = 1e-3;     // largest change of a scheduling variable, in radii, at which iterations end

  QpSettings qp{.tolerance = 1e-6, .max_iterations = 80};
};

class LpvAffineMpc final : public Controller {
 public:
  // `course` must outlive it.
  LpvAffineMpc(const VehicleParameters& vehicle, const Course& course, const LpvAffineSettings& settings);

  [[nodiscard]] int horizon() const override { return settings_.horizon; }
  [[nodiscard]] const Plan& Step(const ControllerInput& input) override;
  void Reset() override;

  // The QP of the last step, and its reference: for recording and for tests.
  [[nodiscard]] const OcpQp<8, 2>& qp() const { return qp_; }
  [[nodiscard]] std::span<const State> reference() const { return z_ref_; }
  [[nodiscard]] std::span<const Input> reference_input() const { return u_ref_; }

 private:
  void Place(const State& z);
  void DecidePassing(std::span<const Obstacle> obstacles);
  [[nodiscard]] bool Hold(const Input& u_previous);
  void CompareScheduling();
  void Predict();
  void Solve(const ControllerInput& input);
  void BuildQp(const Input& u_previous, std::span<const Obstacle> obstacles);
  void BuildRows(const Input& u_previous, std::span<const Obstacle> obstacles, int i);
  void Name(int i, ConstraintKind kind, int index);  // of the row of stage i that was added last
  void AddInputRows(const Input& u_previous, int i);
  void AddFrictionRows(int i);
  void AddRoadRows(int i);
  void AddTrustRegion(int i);
  void AddObstacleRows(std::span<const Obstacle> obstacles, int i);
  [[nodiscard]] std::optional<HalfSpace> Outside(const Obstacle& obstacle, Passage passage, int i) const;
  [[nodiscard]] double ReadPlan();
  void MeasureRelaxation();

  LpvAffineSettings settings_;
  DiscreteModel model_;
  const Course* course_;
  ProgressReference progress_;
  PassingPlanner passing_;
  OcpQp<8, 2> qp_;
  OcpQpSolver<8, 2> solver_;
  std::vector<std::array<Constraint, kMaxRows>> constraints_;  // what the rows of each stage stand for
  bool fits_ = true;                                           // all rows of the QP found room in its stages
  Plan plan_;

  State z_ = State::Zero();  // measured, ψ within π of the course's
  double s_ = 0.0;           // its place on the course [m]
  double lateral_ = 0.0;     // and beside it, left positive [m]
  bool placed_ = false;      // since the last Reset
  bool holding_ = false;     // at standstill
  std::span<const PassingDecision> decisions_;
  std::vector<StopLine> stops_;
  std::optional<std::size_t> first_stop_;  // index of the obstacle that it stops for
  std::vector<State> z_ref_;
  std::vector<Input> u_ref_;
  std::vector<double> s_ref_;

  bool has_prediction_ = false;     // false: no plan yet, the reference is the prediction
  std::vector<State> z_hat_;        // ẑ_0..ẑ_N
  std::vector<Input> u_hat_;        // û_0..û_{N−1}
  std::vector<RoutePoint> beside_;  // points of the course beside ẑ_i
  double trust_scale_ = 1.0;        // of the trust region's radii
};

}  // namespace control
