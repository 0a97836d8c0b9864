// The paper's NMPC (eq:nonlinear_MPC): the nonlinear program of nmpc_problem.hpp, solved by Ipopt (ipopt_solver.hpp)
// from the last solution, shifted by one step. It serves comparison only: it allocates, its time has only a coarse
// bound, and two threads must not solve at the same time.
//
// Its solution is local. The start decides on which side an obstacle is passed (assum_1): points of it that lie
// inside the obstacle are first moved out on that side.
//
// Status: that of ipopt_solver.hpp.
#pragma once

#include <optional>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/mpc/mpc_settings.hpp"
#include "control/mpc/tracking_controller.hpp"
#include "control/nmpc/ipopt_solver.hpp"
#include "control/nmpc/nmpc_problem.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

struct NmpcSettings : MpcSettings {
  double tolerance = 1e-4;  // Ipopt's (paper, Section Results); leaves an error of up to 5e-3 in the input
  int max_iterations = 100;
  double max_cpu_time = 0.25;  // limit for one step [s]
};

class Nmpc final : public TrackingController {
 public:
  // Throws std::runtime_error if Ipopt refuses its options.
  Nmpc(const VehicleParameters& vehicle, const NmpcSettings& settings);

  [[nodiscard]] int horizon() const override { return settings_.horizon; }
  [[nodiscard]] const Plan& Step(const TrackingInput& input) override;
  void Reset() override { has_guess_ = false; }
  [[nodiscard]] std::optional<ConstraintViolation> DiagnoseInfeasibility() const override;

 private:
  void StartFromReference(const TrackingInput& input);
  void MoveOutOfObstacles(const TrackingInput& input);
  void Shift();

  NmpcSettings settings_;
  NmpcProblem problem_;
  IpoptSolver solver_;
  NonlinearPoint point_;      // where the next solve starts
  bool has_guess_ = false;    // point_ comes from the last solution
  std::vector<double> last_;  // x at the end of the last solve
  Plan plan_;
};

}  // namespace control
