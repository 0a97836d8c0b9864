#include "loop/command_source.hpp"

namespace loop {

control::Input CommandSource::Applied(const VehicleState& state, bool commanding) const {
  return !commanding && state.complete ? state.feedback : applied_;
}

safety::LimitResult CommandSource::Command(bus::Mode mode, std::int64_t step, const ActivePlan& plan,
                                           const control::RouteMotion& motion, const VehicleState& state,
                                           const control::Input& applied) const {
  if (bus::Drives(mode)) {
    return limiter_.Limit(plan.At(step), applied, plan.Age(step));
  }
  if (mode == bus::Mode::kSafeStop) {
    // First the steering of the rest of the last plan, then steering along its path; δ never jumps to zero.
    const double delta = plan.Covers(step) ? plan.At(step)[control::kDelta]
                                           : stop_.Steering(motion, stop_offset_, applied[control::kDelta]);
    return limiter_.Limit({delta, -stop_deceleration_}, applied, 0);
  }
  return Measured(state);
}

safety::LimitResult CommandSource::Measured(const VehicleState& state) const {
  return limiter_.Limit(state.feedback, state.feedback, 0);
}

}  // namespace loop
