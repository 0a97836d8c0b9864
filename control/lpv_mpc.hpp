// The LPVMPC of the paper (eq:LPV_MPC, alg:LPVMPC): a QP whose model A(p̂), B(p̂) is scheduled by the last
// plan, with the scheduling trust region or without it ("standard"), obstacle half-spaces and road bounds.
//
// The QP's state is x = [z − z_ref; u_{k−1}]: deviations keep the digits that positions of hundreds of metres
// would cost, and the input last applied makes the rate limits rows of a stage.
#pragma once

#include <numbers>

#include "control/controller.hpp"
#include "control/lpv_model.hpp"
#include "control/ocp_qp_solver.hpp"
#include "control/vehicle_parameters.hpp"

namespace control {

// Defaults: the paper's tables and text; the trust region, which it leaves open, as tried.
struct LpvMpcSettings {
  int horizon = 8;    // N
  double t_s = 0.05;  // [s]
  Discretisation discretisation = Discretisation::kEuler;

  // Weights of z − z_ref in the order of z, and of u.
  State Q{10.0, 10.0, 1.0, 1.0, 10.0, 1.0};
  State P{10.0, 10.0, 1.0, 1.0, 10.0, 1.0};
  Input R{0.1, 0.1};

  // Bounds (tab:MPCPar); that on ψ is taken relative to the reference.
  State z_min{-1.0, -600.0, 1.0, -10.0, -std::numbers::pi, -std::numbers::pi / (3.0 * 0.05)};
  State z_max{1500.0, 800.0, 100.0, 10.0, std::numbers::pi, std::numbers::pi / (3.0 * 0.05)};
  Input u_min{-34.0 * std::numbers::pi / 180.0, -6.0};
  Input u_max{34.0 * std::numbers::pi / 180.0, 2.0};
  Input rate_max{25.0 * std::numbers::pi / 180.0, 1.5};  // per step

  bool trust_region = true;
  Eigen::Vector4d trust_radius{0.5, 0.3, 0.05, 0.05};  // e_max of υ [m/s], ν [m/s], ψ [rad], δ [rad]
  Eigen::Vector4d E_p{1e3, 1e3, 1e3, 1e3};             // weights of their slacks

  double obstacle_margin = 0.1;  // [m] by which obstacles are enlarged

  QpSettings qp{};
};

class LpvMpc final : public Controller {
 public:
  LpvMpc(const VehicleParameters& vehicle, const LpvMpcSettings& settings);

  [[nodiscard]] int horizon() const override { return settings_.horizon; }
  [[nodiscard]] const Plan& Step(const ControllerInput& input) override;
  void Reset() override;

  // The QP of the last step, for recording and for tests.
  [[nodiscard]] const OcpQp<8, 2>& qp() const { return qp_; }

 private:
  void BuildQp(const ControllerInput& input);
  void BuildRows(const ControllerInput& input, int i);
  void ReadPlan(const ControllerInput& input);
  void MeasureTrustRegion();
  void PredictNext();

  LpvMpcSettings settings_;
  LpvModel model_;
  OcpQp<8, 2> qp_;
  OcpQpSolver<8, 2> solver_;
  OcpQpPoint<8, 2> guess_;
  Plan plan_;
  bool has_guess_ = false;          // guess_ holds the last step's solution, shifted
  bool has_prediction_ = false;     // false: no plan yet, schedule from the measured state
  std::vector<State> predicted_z_;  // ẑ, û: the last plan, shifted to the present
  std::vector<Input> predicted_u_;
};

}  // namespace control
