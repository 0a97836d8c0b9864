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
#include <span>
#include <vector>

#include "control/mpc/controller.hpp"
#include "control/mpc/lpv_affine_settings.hpp"
#include "control/mpc/prediction.hpp"
#include "control/mpc/tracking_problem.hpp"
#include "control/qp/ocp_qp_solver.hpp"
#include "control/road/road_profile.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

class LpvAffineMpc final : public Controller {
 public:
  // `course` must outlive it.
  LpvAffineMpc(const VehicleParameters& vehicle, const RoadProfile& course,
               const LpvAffineSettings& settings);

  [[nodiscard]] int horizon() const override { return settings_.horizon; }
  [[nodiscard]] RouteProgress ProgressAt(const RoutePlace& place) const override {
    return ProgressByPlace(place);
  }
  [[nodiscard]] const Plan& Step(const ControllerInput& input) override;
  void Reset() override;
  [[nodiscard]] bool SetQpObserver(const QpObserver& observer) override;

  // The QP of the last step, and its reference: for recording and for tests.
  [[nodiscard]] const OcpQp<8, 2>& qp() const { return qp_; }
  [[nodiscard]] std::span<const State> reference() const { return task_.reference(); }
  [[nodiscard]] std::span<const Input> reference_input() const { return task_.reference_input(); }

 private:
  void CompareScheduling();
  void Solve(const ControllerInput& input);
  [[nodiscard]] bool BuildQp(const Input& u_previous);
  [[nodiscard]] bool AddInputRows(const Input& u_previous, int i);
  [[nodiscard]] bool AddFrictionRows(int i);
  [[nodiscard]] bool AddTrustRegion(int i);
  [[nodiscard]] bool AddBodyRows(int i);
  void Name(int i, ConstraintKind kind, int index);  // of the row of stage i that was added last
  [[nodiscard]] double ReadPlan();
  void MeasureRelaxation();

  LpvAffineSettings settings_;
  DiscreteModel model_;
  TrackingProblem task_;
  OcpQp<8, 2> qp_;
  OcpQpSolver<8, 2> solver_;
  OcpQpPoint<8, 2> guess_;
  std::vector<std::array<Constraint, kMaxRows>> constraints_;  // what the rows of each stage stand for
  Plan plan_;
  QpObserver show_qp_;

  Prediction prediction_;
  bool has_guess_ = false;    // guess_ holds the last QP's solution, shifted where that was the last step's
  double trust_scale_ = 1.0;  // of the trust region's radii
};

}  // namespace control
