#include "control/mpc/prediction.hpp"

#include <algorithm>

namespace control {

Prediction::Prediction(int horizon)
    : z_(static_cast<std::size_t>(horizon) + 1, State::Zero()),
      u_(static_cast<std::size_t>(horizon), Input::Zero()) {}

void Prediction::Hold(const State& z, const Input& u) {
  std::ranges::fill(z_, z);
  std::ranges::fill(u_, u);
}

void Prediction::Follow(const State& measured, std::span<const State> z_ref, std::span<const Input> u_ref) {
  std::ranges::copy(z_ref, z_.begin());
  std::ranges::copy(u_ref, u_.begin());
  z_[0] = measured;
}

void Prediction::RollOut(const State& z, const DiscreteModel& model) {
  z_[0] = z;
  for (std::size_t i = 0; i < u_.size(); ++i) z_[i + 1] = model.Step(z_[i], u_[i]);
}

void Prediction::Set(const Plan& plan) {
  std::ranges::copy(plan.z, z_.begin());
  std::ranges::copy(plan.u, u_.begin());
  exists_ = true;
}

void Prediction::Shift() {
  std::shift_left(z_.begin(), z_.end(), 1);
  std::shift_left(u_.begin(), u_.end(), 1);
}

}  // namespace control
