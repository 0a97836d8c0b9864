#include "loop/step_counter.hpp"

#include <algorithm>

#include "dbc/e2e.hpp"

namespace loop {

void StepCounter::CountState(std::uint8_t counter) {
  constexpr int kModulus = dbc::kCounterModulus;
  std::int64_t step = step_ + 1;
  if (state_counter_ >= 0) {
    const std::int64_t expected = state_counter_ + (step_ - state_step_);
    const auto ahead = static_cast<int>((counter - expected % kModulus + kModulus) % kModulus);
    step = step_ + (ahead > kModulus / 2 ? ahead - kModulus : ahead);
    if (step <= state_step_) {
      step = std::max(step_, state_step_ + 1);
    }
  }
  step_ = step;
  state_step_ = step;
  state_counter_ = counter;
}

}  // namespace loop
