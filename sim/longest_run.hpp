// The longest time for which a condition held without a break.
#pragma once

#include <algorithm>

namespace sim {

class LongestRun {
 public:
  explicit LongestRun(double period) : period_(period) {}  // of a cycle [s]

  // Whether the condition holds in this cycle.
  void Take(bool holds) {
    present_ = holds ? present_ + 1 : 0;
    longest_ = std::max(longest_, present_);
  }

  [[nodiscard]] double present() const { return present_ * period_; }  // [s]
  [[nodiscard]] double longest() const { return longest_ * period_; }  // [s]

 private:
  double period_;
  int present_ = 0;  // [cycles]
  int longest_ = 0;
};

}  // namespace sim
