// Which step of time it is: t_s goes by from one to the next. The timer counts roughly, the counter of the state
// sets exactly but modulo 15; together they count exactly, however many sets are missing.
#pragma once

#include <cstdint>

namespace loop {

class StepCounter {
 public:
  // A cycle without a state.
  void CountTimer() { ++step_; }

  // A cycle with a state set of this counter, 0..14: of all steps with that counter the one nearest to what the
  // timer counted. If that one is over already, the vehicle counts anew, and the timer's count holds.
  void CountState(std::uint8_t counter);

  [[nodiscard]] std::int64_t step() const { return step_; }

 private:
  std::int64_t step_ = 0;
  std::int64_t state_step_ = 0;  // of the last state set
  int state_counter_ = -1;       // of the last state set, -1 before the first
};

}  // namespace loop
