// The LPVMPC with a model that is exact to first order: the paper's scheduling by the last plan (eq:LPV_MPC,
// alg:LPVMPC) and its trust region, but expanded about the predicted trajectory (ẑ, û):
//
//   z_{i+1} = F(ẑ_i, û_i) + A_i (z_i − ẑ_i) + B_i (u_i − û_i)        A = ∂F/∂z, B = ∂F/∂u
//
// with F of control/vehicle/discrete_model.hpp. So a change of heading moves the vehicle inside the QP, too, and one QP
// is one iteration of sequential quadratic programming. The controller knows the road itself and needs no reference
// window (control/traffic/progress_reference.hpp).
//
//   min   Σ |z_i − z_ref_i|²_Q + |u_i − u_ref_i|²_R + |Δu_i|²_R_rate + penalties
//   hard  |Δu_i| ≤ rate_max, u_min ≤ u_i ≤ u_max
//   soft  0 ≤ υ ≤ υ_max;   road and obstacles with the vehicle's footprint;
//         |υω − a_y| ≤ r, |υω − a_y ± a| ≤ √2 r: with |a| ≤ r among the bounds of a, an octagon about the
//         friction circle of radius r;
//         |p_i − p̂_i| ≤ e for p = [υ ν ψ δ]: the trust region
//
// F contains the step's disturbance (control/vehicle/disturbance.hpp), and so does the reference, so that a lasting
// disturbance leaves no offset.
//
// Q, R weigh deviations from the reference, which includes the inputs δ_ref, a_ref. The QP's state is
// x = [z − z_ref; u_{k−1} − u_ref] and its input is Δu, so that every bound of an input is one of a single variable.
#pragma once

#include <span>

#include "control/mpc/controller.hpp"
#include "control/mpc/lpv_affine_settings.hpp"
#include "control/mpc/prediction.hpp"
#include "control/mpc/row_writer.hpp"
#include "control/mpc/tracking_problem.hpp"
#include "control/mpc/trust_region.hpp"
#include "control/mpc/vehicle_qp.hpp"
#include "control/qp/solver.hpp"
#include "control/road/road_profile.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

class LpvAffineMpc final : public Controller {
 public:
  // `profile` must outlive the controller.
  LpvAffineMpc(const VehicleParameters& vehicle, const RoadProfile& profile,
               const LpvAffineSettings& settings);

  [[nodiscard]] int horizon() const override { return settings_.horizon; }
  [[nodiscard]] RouteProgress ProgressAt(const RoutePlace& place) const override {
    return ProgressByPlace(place);
  }
  [[nodiscard]] const Plan& Step(const ControllerInput& input) override;
  void Reset() override;
  [[nodiscard]] bool SetQpObserver(const QpObserver& observer) override;

  // The QP of the last step and its reference, for recording and for tests.
  [[nodiscard]] const VehicleQp& qp() const { return qp_; }
  [[nodiscard]] std::span<const State> reference() const { return tracking_.reference(); }
  [[nodiscard]] std::span<const Input> reference_input() const { return tracking_.reference_input(); }

 private:
  void CompareScheduling();
  void Solve(const ControllerInput& input);
  [[nodiscard]] bool BuildQp(const Input& u_previous);
  void AddInputRows(const Input& u_previous, int i);
  void AddFrictionRows(int i);
  void AddTrustRegion(int i);
  void AddBodyRows(int i);
  [[nodiscard]] double ReadPlan();
  void MeasureRelaxation();

  VehicleParameters vehicle_;
  LpvAffineSettings settings_;
  DiscreteModel model_;  // with the disturbance of the step
  TrackingProblem tracking_;
  VehicleQp qp_;
  RowWriter rows_;
  VehicleQpSolver solver_;
  VehicleQpPoint warm_start_;
  Plan plan_;
  QpObserver qp_observer_;

  Prediction prediction_;
  TrustRegion trust_region_;
  Disturbance disturbance_;      // of this step
  double grip_ = 0.0;            // r of this step [m/s²]
  bool has_warm_start_ = false;  // warm_start_ holds the last QP's solution; Step leaves it shifted
};

}  // namespace control
