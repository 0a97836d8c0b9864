// The trajectory (ẑ, û) about which a controller puts the problem of a step: the last plan, shifted to the present (paper,
// eq:sch_pred).
#pragma once

#include <span>
#include <vector>

#include "control/mpc/controller.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/types.hpp"

namespace control {

// Nothing but the constructor allocates.
class Prediction {
 public:
  explicit Prediction(int horizon);

  // Without a plan: the same state and input throughout.
  void Hold(const State& z, const Input& u);
  // Without a plan: this reference, but for the measured state.
  void Follow(const State& measured, std::span<const State> z_ref, std::span<const Input> u_ref);
  // The trajectory of its inputs from a measured state on, through the nonlinear model.
  void RollOut(const State& z, const DiscreteModel& model);
  // Makes this plan the prediction, for the rest of the step and, shifted, for the next one.
  void Set(const Plan& plan);
  // Ends a step.
  void Shift();
  // There is no plan any more.
  void Clear() { exists_ = false; }

  [[nodiscard]] bool exists() const { return exists_; }             // it stems from a plan
  [[nodiscard]] const std::vector<State>& z() const { return z_; }  // ẑ_0..ẑ_N
  [[nodiscard]] const std::vector<Input>& u() const { return u_; }  // û_0..û_{N−1}

 private:
  bool exists_ = false;
  std::vector<State> z_;
  std::vector<Input> u_;
};

}  // namespace control
