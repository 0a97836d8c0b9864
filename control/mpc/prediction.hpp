// The trajectory (ẑ, û) about which lpv-affine, and the NMPC with the same problem, put the problem of a step: where the
// shifted last plan leads from the measured state (paper, eq:sch_pred, through the nonlinear model), and without a plan
// the reference, which is near.
#pragma once

#include <vector>

#include "control/mpc/controller.hpp"
#include "control/mpc/lpv_affine_terms.hpp"
#include "control/mpc/tracking_problem.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/types.hpp"

namespace control {

class Prediction {
 public:
  explicit Prediction(int horizon);

  // A step begins; the task has begun it. Does not allocate, nor do the others.
  void Begin(const TrackingProblem& task, const DiscreteModel& model);
  // This plan is the prediction, for the rest of the step and, shifted, for the next one.
  void Take(const Plan& plan);
  // A step ends.
  void Shift();
  // There is no plan.
  void Drop() { exists_ = false; }

  [[nodiscard]] bool exists() const { return exists_; }             // false: no plan, it is the reference
  [[nodiscard]] const std::vector<State>& z() const { return z_; }  // ẑ_0..ẑ_N
  [[nodiscard]] const std::vector<Input>& u() const { return u_; }  // û_0..û_{N−1}

  // Calls visit(planned, predicted, index of its radius) for each scheduling variable of a plan that can differ.
  template <typename Visit>
  void Compare(const Plan& plan, const Visit& visit) const {
    using namespace lpv_affine;
    for (std::size_t i = 1; i < z_.size(); ++i) {
      visit(plan.u[i - 1][kDelta], u_[i - 1][kDelta], kScheduledDelta);
      for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
        visit(plan.z[i][kScheduledStates[j]], z_[i][kScheduledStates[j]], j);
      }
    }
  }

 private:
  bool exists_ = false;
  std::vector<State> z_;
  std::vector<Input> u_;
};

}  // namespace control
