#include "loop/command_source.hpp"

namespace loop {

control::Input CommandSource::Applied(const VehicleState& state, bool commanding) const {
  return !commanding && state.complete ? state.feedback : applied_;
}

safety::LimitResult CommandSource::Command(bus::Mode mode, std::int64_t step, const ActivePlan& plan,
                                           const control::Input& stop, const VehicleState& state,
                                           const control::Input& applied) const {
  if (bus::Drives(mode)) {
    return limiter_.Limit(plan.At(step), applied, plan.Age(step));
  }
  if (mode == bus::Mode::kSafeStop) return limiter_.Limit(stop, applied, 0);
  return Measured(state);
}

safety::LimitResult CommandSource::Measured(const VehicleState& state) const {
  return limiter_.Limit(state.feedback, state.feedback, 0);
}

}  // namespace loop
