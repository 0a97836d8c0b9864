// The LPVMPC of the paper (eq:LPV_MPC, alg:LPVMPC): a QP whose model A(p̂), B(p̂) is scheduled by the last
// plan, with the scheduling trust region or without it ("standard"), obstacle half-spaces and road bounds.
//
// The QP's state is x = [z − z_ref; u_{k−1}]: deviations keep the digits that positions of hundreds of metres
// would cost, and the input last applied makes the rate limits rows of a stage.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "control/mpc/mpc_settings.hpp"
#include "control/mpc/tracking_controller.hpp"
#include "control/qp/ocp_qp_solver.hpp"
#include "control/vehicle/lpv_model.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// The trust region, whose size the paper leaves open, is as tried.
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
  // The row that needs the largest slack if the rows that hold states (bounds, road, obstacles) are made soft.
  [[nodiscard]] std::optional<ConstraintViolation> DiagnoseInfeasibility() const override;
  [[nodiscard]] bool SetQpObserver(const QpObserver& observer) override;

  // The QP of the last step, for recording and for tests.
  [[nodiscard]] const OcpQp<8, 2>& qp() const { return qp_; }

 private:
  void BuildQp(const TrackingInput& input);
  void BuildRows(const TrackingInput& input, int i);
  void ReadPlan(const TrackingInput& input);
  void MeasureTrustRegion();
  void PredictNext();

  LpvMpcSettings settings_;
  LpvModel model_;
  OcpQp<8, 2> qp_;
  std::vector<std::array<Constraint, kMaxRows>> constraints_;  // what the rows of each stage stand for
  OcpQpSolver<8, 2> solver_;
  // Room for DiagnoseInfeasibility, which must not take it in a control cycle.
  mutable OcpQp<8, 2> elastic_;
  mutable OcpQpSolver<8, 2> elastic_solver_;
  OcpQpPoint<8, 2> guess_;
  Plan plan_;
  QpObserver show_qp_;
  bool has_guess_ = false;          // guess_ holds the last step's solution, shifted
  bool has_prediction_ = false;     // false: no plan yet, schedule from the measured state
  std::vector<State> predicted_z_;  // ẑ, û: the last plan, shifted to the present
  std::vector<Input> predicted_u_;
};

}  // namespace control
