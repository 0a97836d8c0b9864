#include "loop/state_assembler.hpp"

#include <algorithm>

namespace loop {

bool StateAssembler::Update(const bus::VehiclePose& pose, std::uint8_t counter, base::Time time) {
  Begin(kPose, counter, time);
  next_.z[control::kX] = pose.X;
  next_.z[control::kY] = pose.Y;
  return Finish(kPose);
}

bool StateAssembler::Update(const bus::VehicleMotion& motion, std::uint8_t counter, base::Time time) {
  Begin(kMotion, counter, time);
  next_.z[control::kUpsilon] = motion.upsilon;
  next_.z[control::kNu] = motion.nu;
  next_.z[control::kOmega] = motion.omega;
  return Finish(kMotion);
}

bool StateAssembler::Update(const bus::VehicleFeedback& feedback, std::uint8_t counter, base::Time time) {
  Begin(kFeedback, counter, time);
  next_.z[control::kPsi] = control::WrapAngle(feedback.psi);
  next_.feedback[control::kDelta] = feedback.delta;
  next_.feedback[control::kAcceleration] = feedback.acceleration;
  return Finish(kFeedback);
}

void StateAssembler::Begin(Part part, std::uint8_t counter, base::Time time) {
  // A repeated or late part means that the counter has wrapped around: it begins a new set, too.
  const bool other = counter != next_.counter || (parts_ & part) != 0 || time - next_.timestamp > longest_;
  if (parts_ != 0 && other) {
    ++dropped_;
    parts_ = 0;
  }
  next_.timestamp = parts_ == 0 ? time : std::min(next_.timestamp, time);
  next_.counter = counter;
}

bool StateAssembler::Finish(Part part) {
  parts_ |= part;
  if (parts_ != kAll) {
    return false;
  }
  parts_ = 0;
  if (!next_.z.allFinite() || !next_.feedback.allFinite()) {
    ++dropped_;
    return false;
  }
  state_ = next_;
  state_.complete = true;
  return true;
}

}  // namespace loop
