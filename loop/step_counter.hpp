// Counts time steps of length t_s. The timer counts roughly, the counter of the state sets exactly but modulo 15;
// together they count exactly, however many sets are missing.
#pragma once

#include <cstdint>

namespace loop {

class StepCounter {
 public:
  // A cycle without a state.
  void CountTimer() { ++step_; }

  // A state set with this counter, 0..14: the step becomes the one with that counter nearest to the timer's count. If
  // this is not after the last state's step, the vehicle has restarted its counter and the timer's count is kept (but
  // at least the step after the last state's).
  void CountState(std::uint8_t counter);

  [[nodiscard]] std::int64_t step() const { return step_; }

 private:
  std::int64_t step_ = 0;
  std::int64_t state_step_ = 0;  // step of the last state set
  int state_counter_ = -1;       // counter of the last state set, -1 before the first
};

}  // namespace loop
