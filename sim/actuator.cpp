#include "sim/actuator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sim {

Actuator::Actuator(const ActuatorParameters& parameters, double initial)
    : parameters_(parameters),
      delayed_(static_cast<std::size_t>(parameters.delay_cycles), initial),
      target_(initial),
      value_(initial) {}

void Actuator::Command(double value) {
  if (!delayed_.empty()) {
    std::swap(value, delayed_[next_]);
    next_ = (next_ + 1) % delayed_.size();
  }
  target_ = std::clamp(value, parameters_.min, parameters_.max);
}

void Actuator::Override(double value) {
  target_ = std::clamp(value, parameters_.min, parameters_.max);
  std::ranges::fill(delayed_, target_);
}

void Actuator::Advance(double dt) {
  const double tau = parameters_.time_constant;
  const double gap = std::abs(target_ - value_);
  // It moves at the greatest rate until the lag demands less, then exponentially.
  const double band = tau > 0.0 ? parameters_.rate * tau : 0.0;
  if (gap > band && std::isfinite(parameters_.rate)) {
    const double time = std::min(dt, (gap - band) / parameters_.rate);
    value_ += std::copysign(parameters_.rate * time, target_ - value_);
    dt -= time;
    if (dt <= 0.0) return;
  }
  if (tau > 0.0) {
    value_ = target_ + (value_ - target_) * std::exp(-dt / tau);
  } else {
    value_ = target_;
  }
}

}  // namespace sim
