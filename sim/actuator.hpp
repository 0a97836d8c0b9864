// An actuator: a pure delay of whole control cycles, then a first-order lag with limited rate and range.
//
//   ẋ = clamp((command − x) / τ, ±rate),   command clamped to the range; τ = 0: x moves at `rate`, or jumps
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace sim {

struct ActuatorParameters {
  double time_constant = 0.0;                             // τ >= 0 [s]
  double rate = std::numeric_limits<double>::infinity();  // > 0 [unit/s]
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  int delay_cycles = 0;  // >= 0
};

class Actuator {
 public:
  Actuator(const ActuatorParameters& parameters, double initial);

  // Exactly one of the two is called per cycle. A command takes effect after the delay, an override at once; the
  // commands that are still delayed are then lost.
  void Command(double value);
  void Override(double value);
  // Advances by dt >= 0 [s]; exact for a constant command, whatever dt is.
  void Advance(double dt);

  [[nodiscard]] double value() const { return value_; }

 private:
  ActuatorParameters parameters_;
  std::vector<double> delayed_;  // ring buffer of the delayed commands
  std::size_t next_ = 0;
  double target_;
  double value_;
};

}  // namespace sim
