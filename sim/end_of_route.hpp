// How exactly a drive ended at the route's end.
#pragma once

#include <algorithm>
#include <optional>

namespace sim {

class EndOfRoute {
 public:
  // Arc length that is left to the route's end, of one cycle; negative past it [m].
  void Take(double left) {
    last_ = left;
    least_ = std::min(least_.value_or(left), left);
  }

  // How far the vehicle got past the end or, negative, how far short of it it was at last [m]; none if it was never
  // within the last 5 m.
  [[nodiscard]] std::optional<double> Overshoot() const {
    constexpr double kReached = 5.0;
    if (!least_ || *least_ > kReached) return std::nullopt;
    return *least_ < 0.0 ? -*least_ : -last_;
  }

 private:
  double last_ = 0.0;
  std::optional<double> least_;
};

}  // namespace sim
