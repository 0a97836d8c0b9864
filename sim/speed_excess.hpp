// The greatest speed over what is allowed. A vehicle that starts too fast is allowed its first speed, less 1 m/s each
// second, until it has once been at or below the target.
#pragma once

#include <algorithm>
#include <optional>

namespace sim {

class SpeedExcess {
 public:
  explicit SpeedExcess(double period) : period_(period) {}  // of a cycle [s]

  // The vehicle's speed and the target at its place [m/s], once per cycle.
  void Take(double speed, double target) {
    constexpr double kSlowing = 1.0;  // [m/s²]
    bound_ = started_ ? bound_ - kSlowing * period_ : speed;
    started_ = true;
    settled_ = settled_ || speed <= target;
    const double allowed = settled_ ? target : std::max(target, bound_);
    greatest_ = std::max(greatest_, speed - allowed);
  }

  // 0 if the speed was never above; none without a cycle [m/s].
  [[nodiscard]] std::optional<double> Greatest() const {
    return started_ ? std::optional(greatest_) : std::nullopt;
  }

 private:
  double period_;
  bool started_ = false;
  bool settled_ = false;  // was at or below the target once
  double bound_ = 0.0;    // what a start that was too fast is allowed now [m/s]
  double greatest_ = 0.0;
};

}  // namespace sim
