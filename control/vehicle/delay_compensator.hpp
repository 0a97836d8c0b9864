// Where the vehicle is when a command that is given now begins to act: between command and effect pass the bus, the
// actuator's dead time and, in the end, its lag, and meanwhile the commands act that were given before.
#pragma once

#include <array>

#include "control/vehicle/blended_model.hpp"
#include "control/vehicle/types.hpp"

namespace control {

class DelayCompensator {
 public:
  static constexpr double kLongest =
      0.5;  // of delay and age together [s]; of a longer one this much is made up for

  // `t_s`: time between two commands, >= 0.005; `delay` from a command to its effect, >= 0 [s].
  DelayCompensator(const VehicleParameters& vehicle, double t_s, double delay);

  // Once a cycle: the command that was given.
  void Given(const Input& u);
  // The vehicle is driven by others: these inputs act, and have done so.
  void Reset(const Input& u) { given_.fill(u); }

  // The state `delay` after now, of a state measured `age` >= 0 [s] before now. The newest command given is that of the
  // cycle before.
  [[nodiscard]] State Ahead(const State& z, double age) const;

  [[nodiscard]] double delay() const { return delay_; }

 private:
  static constexpr std::size_t kMost = 101;  // commands within kLongest

  BlendedModel model_;
  double t_s_;
  double delay_;
  std::array<Input, kMost> given_;  // ring
  std::size_t newest_ = 0;
};

}  // namespace control
