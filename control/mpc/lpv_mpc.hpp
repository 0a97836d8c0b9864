// The LPVMPC of the paper (eq:LPV_MPC, alg:LPVMPC): a QP whose model A(p̂), B(p̂) is scheduled by the last
// plan, with or without ("standard") the scheduling trust region, with obstacle half-spaces and road bounds.
//
// The QP's state is x = [z − z_ref; u_{k−1}]: deviations keep the digits that positions of hundreds of metres
// would cost, and with the previous input in the state the rate limits are rows of a single stage.
#pragma once

#include <optional>

#include "control/mpc/mpc_settings.hpp"
#include "control/mpc/prediction.hpp"
#include "control/mpc/row_writer.hpp"
#include "control/mpc/tracking_controller.hpp"
#include "control/mpc/trust_region.hpp"
#include "control/mpc/vehicle_qp.hpp"
#include "control/qp/solver.hpp"
#include "control/vehicle/lpv_model.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// The paper leaves the trust region's size open; the values here are the result of trials.
struct LpvMpcSettings : MpcSettings {
  Discretisation discretisation = Discretisation::kEuler;

  bool trust_region = true;
  Eigen::Vector4d trust_radius{0.5, 0.3, 0.05, 0.05};  // e_max of υ [m/s], ν [m/s], ψ [rad], δ [rad]
  Eigen::Vector4d E_p{1e3, 1e3, 1e3, 1e3};             // weights of their slacks

  QpSettings qp{};
};

class LpvMpc final : public TrackingController {
 public:
  LpvMpc(const VehicleParameters& vehicle, const LpvMpcSettings& settings);

  [[nodiscard]] int horizon() const override { return settings_.horizon; }
  [[nodiscard]] const Plan& Step(const TrackingInput& input) override;
  void Reset() override;
  // Returns the row that needs the largest slack if all rows of states, road and obstacles are made soft.
  [[nodiscard]] std::optional<ConstraintViolation> DiagnoseInfeasibility() const override;
  [[nodiscard]] bool SetQpObserver(const QpObserver& observer) override;

  // The QP of the last step, for recording and for tests.
  [[nodiscard]] const VehicleQp& qp() const { return qp_; }

 private:
  void BuildQp(const TrackingInput& input);
  void AddRows(const TrackingInput& input, int i);
  void AddInputRows(int i);
  void AddStateRows(const TrackingInput& input, int i);
  void AddSteeringTrust(int i);
  void AddStateTrust(const State& z_ref, int i);
  void AddObstacleRows(const TrackingInput& input, int i);
  void ReadPlan(const TrackingInput& input);
  void PredictNext();

  LpvMpcSettings settings_;
  LpvModel model_;
  VehicleQp qp_;
  RowWriter rows_;
  VehicleQpSolver solver_;
  // Work space of DiagnoseInfeasibility, kept because nothing may be allocated in a control cycle.
  mutable VehicleQp elastic_;
  mutable VehicleQpSolver elastic_solver_;
  VehicleQpPoint warm_start_;
  Plan plan_;
  QpObserver qp_observer_;
  Prediction prediction_;
  TrustRegion trust_region_;
  bool has_warm_start_ = false;  // warm_start_ holds the shifted solution of the last step
};

}  // namespace control
