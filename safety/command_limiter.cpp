#include "safety/command_limiter.hpp"

#include <algorithm>

namespace safety {
namespace {

double Clamp(double value, double lo, double hi, bool& limited) {
  const double clamped = std::clamp(value, lo, hi);
  limited = clamped != value;
  return clamped;
}

}  // namespace

LimitResult CommandLimiter::Limit(const control::Input& wanted, const control::Input& applied,
                                  int age) const {
  if (!wanted.allFinite() || !applied.allFinite()) return {};  // kNotFinite
  if (age < 0 || age > limits_.max_age) return {.status = LimitStatus::kTooOld};
  LimitResult result;
  const CommandLimits& l = limits_;
  // `applied` is clamped to the range first, so that limiting the rate cannot leave the range: both limits hold.
  const double delta_applied = std::clamp(applied[control::kDelta], -l.max_steering, l.max_steering);
  const double a_applied =
      std::clamp(applied[control::kAcceleration], l.min_acceleration, l.max_acceleration);
  control::Input u = wanted;
  u[control::kDelta] = Clamp(u[control::kDelta], -l.max_steering, l.max_steering, result.steering_range);
  u[control::kDelta] = Clamp(u[control::kDelta], delta_applied - l.max_steering_step,
                             delta_applied + l.max_steering_step, result.steering_rate);
  u[control::kAcceleration] =
      Clamp(u[control::kAcceleration], l.min_acceleration, l.max_acceleration, result.acceleration_range);
  u[control::kAcceleration] = Clamp(u[control::kAcceleration], a_applied - l.max_acceleration_step,
                                    a_applied + l.max_acceleration_step, result.acceleration_rate);
  const bool limited =
      result.steering_range || result.steering_rate || result.acceleration_range || result.acceleration_rate;
  result.status = limited ? LimitStatus::kLimited : LimitStatus::kPassed;
  result.command = LimitedCommand(u);
  return result;
}

}  // namespace safety
