// The NMPC with lpv-affine's horizon, cost and constraints: what lpv-affine solves approximately by one QP is solved here
// by Ipopt (affine_nmpc_problem.hpp, ipopt_solver.hpp), from the last solution, shifted by a step. Against its drives
// lpv-affine's are measured. For comparison: it allocates, its time has no bound, and two threads must not solve at the
// same time.
//
// The half-spaces of road and obstacles are, as lpv-affine's, those about a predicted trajectory: the shifted last solution
// from the measured state on, or the reference in a first step. Where the solution is far from it, it is the next
// prediction, and there is another round. The solution is a local one, on the sides that driving_task.hpp decides for.
//
// Status: that of ipopt_solver.hpp; kNumericalFailure, too, if a value is not finite, or if an obstacle finds no room.
#pragma once

#include <vector>

#include "control/mpc/controller.hpp"
#include "control/mpc/lpv_affine_settings.hpp"
#include "control/mpc/prediction.hpp"
#include "control/mpc/tracking_problem.hpp"
#include "control/mpc/trust_region.hpp"
#include "control/nmpc/affine_nmpc_problem.hpp"
#include "control/nmpc/ipopt_solver.hpp"
#include "control/road/road_profile.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

struct AffineNmpcSettings {
  double tolerance = 1e-4;  // of Ipopt
  int max_iterations = 200;
  int rounds = 2;  // solves in one step
  double converged =
      0.1;  // largest change of a scheduling variable, in radii of the trust region, that needs none
};

class AffineNmpc final : public Controller {
 public:
  // `course` must outlive it. The trust region, iterations and qp of `problem` have no meaning here. Throws
  // std::runtime_error: Ipopt refuses its options.
  AffineNmpc(const VehicleParameters& vehicle, const RoadProfile& course, const LpvAffineSettings& problem,
             const AffineNmpcSettings& settings = {});

  [[nodiscard]] int horizon() const override { return problem_.horizon(); }
  [[nodiscard]] RouteProgress ProgressAt(const RoutePlace& place) const override {
    return ProgressByPlace(place);
  }
  [[nodiscard]] const Plan& Step(const ControllerInput& input) override;
  void Reset() override;

 private:
  void Solve(const Input& u_previous);
  [[nodiscard]] NonlinearPoint Start(const AffineNmpcProblem& last, int shift) const;
  [[nodiscard]] double ReadPlan();
  void MeasureRelaxation();

  AffineNmpcSettings settings_;
  TrustRegion trust_region_;
  DiscreteModel model_;
  TrackingProblem task_;
  AffineNmpcProblem problem_;
  IpoptSolver solver_;
  NonlinearPoint point_;    // of the last solve, of problem_
  bool has_duals_ = false;  // point_ is a solution
  Plan plan_;
  Prediction prediction_;
};

}  // namespace control
