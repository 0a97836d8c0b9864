// Predicts where the vehicle is when a command given now begins to act: between command and effect lie the bus, the
// actuator's dead time and finally its lag, and meanwhile the earlier commands act.
#pragma once

#include <array>

#include "control/vehicle/disturbance.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

class DelayCompensator {
 public:
  static constexpr double kLongest =
      0.5;  // upper limit of delay plus age [s]; only this much of a longer one is compensated

  // `t_s` is the time between two commands, >= 0.005; `delay` is that from a command to its effect, >= 0 [s].
  DelayCompensator(const VehicleParameters& vehicle, double t_s, double delay);

  // Records the command that was given; called once per cycle.
  void Record(const Input& u);
  // Assumes that `u` acts and has been acting: the vehicle is driven by others.
  void Reset(const Input& u) { given_.fill(u); }

  // Predicts the state `delay` after now from the state `z` measured `age` >= 0 [s] before now. The newest command
  // given is that of the previous cycle.
  [[nodiscard]] State Predict(const State& z, double age, const Disturbance& disturbance = {}) const;

  [[nodiscard]] double delay() const { return delay_; }

 private:
  static constexpr std::size_t kMost = 101;  // commands within kLongest

  VehicleParameters vehicle_;
  double t_s_;
  double delay_;
  std::array<Input, kMost> given_;  // ring buffer
  std::size_t newest_ = 0;
};

}  // namespace control
