// The trajectory (ẑ, û) about which a controller formulates the problem of a step: the last plan, shifted to the
// present (paper, eq:sch_pred).
#pragma once

#include <span>
#include <vector>

#include "control/mpc/controller.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/types.hpp"

namespace control {

// Only the constructor allocates.
class Prediction {
 public:
  explicit Prediction(int horizon);

  // Without a plan: predicts the same state and input throughout.
  void Hold(const State& z, const Input& u);
  // Without a plan: predicts the reference, but starts at the measured state.
  void Follow(const State& measured, std::span<const State> z_ref, std::span<const Input> u_ref);
  // Recomputes the states from a measured one with the predicted inputs and the nonlinear model.
  void RollOut(const State& z, const DiscreteModel& model);
  // Makes this plan the prediction, for the rest of the step and, shifted, for the next one.
  void Set(const Plan& plan);
  // Ends a step: moves the prediction on by one sample.
  void Shift();
  // Forgets the plan.
  void Clear() { exists_ = false; }

  [[nodiscard]] bool exists() const { return exists_; }             // true if it stems from a plan
  [[nodiscard]] const std::vector<State>& z() const { return z_; }  // ẑ_0..ẑ_N
  [[nodiscard]] const std::vector<Input>& u() const { return u_; }  // û_0..û_{N−1}

 private:
  bool exists_ = false;
  std::vector<State> z_;
  std::vector<Input> u_;
};

}  // namespace control
