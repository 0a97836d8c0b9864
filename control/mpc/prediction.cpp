#include "control/mpc/prediction.hpp"

#include <algorithm>

namespace control {

Prediction::Prediction(int horizon)
    : z_(static_cast<std::size_t>(horizon) + 1, State::Zero()),
      u_(static_cast<std::size_t>(horizon), Input::Zero()) {}

void Prediction::Begin(const TrackingProblem& task, const DiscreteModel& model) {
  if (!exists_) {
    std::ranges::copy(task.reference(), z_.begin());
    std::ranges::copy(task.reference_input(), u_.begin());
  }
  z_[0] = task.z();
  if (!exists_) return;
  for (std::size_t i = 0; i < u_.size(); ++i) z_[i + 1] = model.Step(z_[i], u_[i]);
}

void Prediction::Take(const Plan& plan) {
  std::ranges::copy(plan.z, z_.begin());
  std::ranges::copy(plan.u, u_.begin());
  exists_ = true;
}

void Prediction::Shift() {
  std::shift_left(z_.begin(), z_.end(), 1);
  std::shift_left(u_.begin(), u_.end(), 1);
}

}  // namespace control
