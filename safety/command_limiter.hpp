// The final check of a command: range, rate (for the acceleration: jerk) and age. Only a limiter can create a
// LimitedCommand, and only a LimitedCommand can be sent.
//
// The default limits are those of the paper (Section V, table of h^u, and the rate limits in the text): |δ| ≤ 34π/180,
// |δ_k − δ_{k−1}| ≤ 25π/180, a ∈ [−6, 2], |a_k − a_{k−1}| ≤ 1.5.
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>

#include "control/vehicle/types.hpp"

namespace safety {

struct CommandLimits {
  double max_steering = 34.0 * std::numbers::pi / 180.0;       // |δ| [rad]
  double max_steering_step = 25.0 * std::numbers::pi / 180.0;  // |δ_k − δ_{k−1}| per cycle [rad]
  double min_acceleration = -6.0;                              // [m/s²]
  double max_acceleration = 2.0;                               // [m/s²]
  // |a_k − a_{k−1}| per cycle [m/s²]: the jerk limit times the period; 1.5 m/s² in 50 ms is 30 m/s³.
  double max_acceleration_step = 1.5;
  int max_age = 200;  // cycles since the plan behind the command was made
};

class LimitedCommand {
 public:
  [[nodiscard]] double steering() const { return u_[control::kDelta]; }
  [[nodiscard]] double acceleration() const { return u_[control::kAcceleration]; }
  [[nodiscard]] const control::Input& u() const { return u_; }

 private:
  friend class CommandLimiter;
  explicit LimitedCommand(const control::Input& u) : u_(u) {}
  control::Input u_;
};

enum class LimitStatus : std::uint8_t {
  kPassed,     // unchanged
  kLimited,    // changed to meet range or rate; the flags show which
  kNotFinite,  // refused: a value of `wanted` or `applied` is NaN or infinite
  kTooOld,     // refused: the age is negative or above the limit
};

struct LimitResult {
  LimitStatus status = LimitStatus::kNotFinite;
  std::optional<LimitedCommand> command{};  // none if refused
  bool steering_range = false;
  bool steering_rate = false;
  bool acceleration_range = false;
  bool acceleration_rate = false;
};

class CommandLimiter {
 public:
  explicit CommandLimiter(const CommandLimits& limits) : limits_(limits) {}

  // `wanted`: δ [rad], a [m/s²]. `applied`: the command of the previous cycle; if it is out of range, the range takes
  // precedence over the rate. `age`: cycles since the plan behind `wanted` was made.
  [[nodiscard]] LimitResult Limit(const control::Input& wanted, const control::Input& applied, int age) const;

  [[nodiscard]] const CommandLimits& limits() const { return limits_; }

 private:
  CommandLimits limits_;
};

}  // namespace safety
