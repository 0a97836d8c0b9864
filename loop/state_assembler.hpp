// Puts the three frames of one state set together: pose, motion and feedback with the same counter.
#pragma once

#include <cstdint>

#include "base/time.hpp"
#include "bus/messages.hpp"
#include "control/vehicle/types.hpp"

namespace loop {

struct VehicleState {
  bool complete = false;                             // false until a first set was complete
  control::State z = control::State::Zero();         // ψ wrapped to (-π, π]
  control::Input feedback = control::Input::Zero();  // δ and a as measured
  std::uint8_t counter = 0;
  base::Time timestamp{};  // of the oldest of the three frames
};

class StateAssembler {
 public:
  // `period` of the sets: two frames further apart than half a round of the counter, 7 periods, never make a set.
  explicit StateAssembler(base::Time period) : longest_(7 * period) {}

  // Each returns true if its frame completes a set, which then is `state()`. A frame of another counter than
  // the set under way begins a new set; the incomplete one is dropped. So is a set with a value that is not
  // finite, which a DBC with floating-point signals can carry.
  [[nodiscard]] bool Update(const bus::VehiclePose& pose, std::uint8_t counter, base::Time time);
  [[nodiscard]] bool Update(const bus::VehicleMotion& motion, std::uint8_t counter, base::Time time);
  [[nodiscard]] bool Update(const bus::VehicleFeedback& feedback, std::uint8_t counter, base::Time time);

  [[nodiscard]] const VehicleState& state() const { return state_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }  // incomplete sets

 private:
  enum Part : unsigned { kPose = 1, kMotion = 2, kFeedback = 4, kAll = 7 };

  void Begin(Part part, std::uint8_t counter, base::Time time);
  [[nodiscard]] bool Finish(Part part);

  base::Time longest_;
  VehicleState state_;
  VehicleState next_;  // the set under way
  unsigned parts_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace loop
