#include "control/vehicle/delay_compensator.hpp"

#include <algorithm>
#include <cmath>

#include "control/vehicle/blended_model.hpp"
#include "control/vehicle/discrete_model.hpp"

namespace control {

DelayCompensator::DelayCompensator(const VehicleParameters& vehicle, double t_s, double delay)
    : vehicle_(vehicle), t_s_(t_s), delay_(std::min(delay, kLongest)) {
  given_.fill(Input::Zero());
}

void DelayCompensator::Record(const Input& u) {
  newest_ = (newest_ + 1) % kMost;
  given_[newest_] = u;
}

// The command of j cycles ago acts from delay − j t_s until delay − (j − 1) t_s.
State DelayCompensator::Predict(const State& z, double age, const Disturbance& disturbance) const {
  constexpr double kNothing = 1e-9;  // [s]
  constexpr double kStep = 0.01;     // longest integration step [s]
  const BlendedModel blended(vehicle_, disturbance);
  State ahead = z;
  double left = std::min(delay_ + age, kLongest);  // time until the new command acts
  while (left > kNothing) {
    const auto j = static_cast<std::size_t>(std::max(std::ceil(left / t_s_ - 1e-6), 1.0));
    const double step = std::min(left - static_cast<double>(j - 1) * t_s_, left);
    const double parts = std::ceil(step / kStep - 1e-6);
    const DiscreteModel model(blended, step / parts);
    const Input& u = given_[(newest_ + kMost - std::min(j - 1, kMost - 1)) % kMost];
    for (int part = 0; part < static_cast<int>(parts); ++part) ahead = model.Step(ahead, u);
    left -= step;
  }
  return ahead;
}

}  // namespace control
