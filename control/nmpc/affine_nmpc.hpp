// The NMPC with lpv-affine's horizon, cost and constraints: Ipopt solves what lpv-affine solves approximately by one
// QP (affine_nmpc_problem.hpp, ipopt_solver.hpp), from the last solution, shifted by one step. Its drives are the
// standard against which lpv-affine's are measured. It serves comparison only: it allocates, its time has no bound,
// and two threads must not solve at the same time.
//
// As in lpv-affine, the half-spaces of road and obstacles are taken about a predicted trajectory: the shifted last
// solution from the measured state on, or the reference in a first step. If the solution is far from the prediction,
// it becomes the next prediction and another round follows. The solution is local, on the sides that
// tracking_problem.hpp decides on.
//
// Status: that of ipopt_solver.hpp, and kNumericalFailure if a value is not finite.
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
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

struct AffineNmpcSettings {
  double tolerance = 1e-4;  // Ipopt's tolerance
  int max_iterations = 200;
  int rounds = 2;  // solves in one step
  double converged =
      0.1;  // largest change of a scheduling variable, in radii of the trust region, without another round
};

class AffineNmpc final : public Controller {
 public:
  // `profile` must outlive this object. The trust region, iterations and qp of `problem` have no meaning here. Throws
  // std::runtime_error if Ipopt refuses its options.
  AffineNmpc(const VehicleParameters& vehicle, const RoadProfile& profile, const LpvAffineSettings& problem,
             const AffineNmpcSettings& settings = {});

  [[nodiscard]] int horizon() const override { return problem_.horizon(); }
  [[nodiscard]] RouteProgress ProgressAt(const RoutePlace& place) const override {
    return ProgressByPlace(place);
  }
  [[nodiscard]] const Plan& Step(const ControllerInput& input) override;
  void Reset() override;

 private:
  void Solve(const ControllerInput& input);
  [[nodiscard]] NonlinearPoint Start(const AffineNmpcProblem& last, int shift) const;
  [[nodiscard]] double ReadPlan();
  void MeasureRelaxation();

  AffineNmpcSettings settings_;
  TrustRegion trust_region_;
  TrackingProblem tracking_;
  AffineNmpcProblem problem_;
  IpoptSolver solver_;
  NonlinearPoint point_;    // result of the last solve of problem_
  bool has_duals_ = false;  // point_ is a solution
  Plan plan_;
  Prediction prediction_;
};

}  // namespace control
