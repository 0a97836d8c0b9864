// Assembles a state set from its three frames: pose, motion and feedback with the same counter.
#pragma once

#include <cstdint>

#include "base/time.hpp"
#include "bus/messages.hpp"
#include "control/vehicle/types.hpp"

namespace loop {

struct VehicleState {
  bool complete = false;                             // false until the first complete set
  control::State z = control::State::Zero();         // ψ wrapped to (-π, π]
  control::Input feedback = control::Input::Zero();  // δ and a as measured
  std::uint8_t counter = 0;
  base::Time timestamp{};  // time stamp of the oldest of the three frames
};

class StateAssembler {
 public:
  // `period`: period of the sets. Frames more than 7 periods apart, half a cycle of the counter, never form a set.
  explicit StateAssembler(base::Time period) : longest_(7 * period) {}

  // Each returns true if its frame completes a set, which is then `state()`. A frame whose counter differs from that of
  // the incomplete set drops it and begins a new set. A set with a non-finite value, which a DBC with floating-point
  // signals can carry, is dropped too.
  [[nodiscard]] bool Update(const bus::VehiclePose& pose, std::uint8_t counter, base::Time time);
  [[nodiscard]] bool Update(const bus::VehicleMotion& motion, std::uint8_t counter, base::Time time);
  [[nodiscard]] bool Update(const bus::VehicleFeedback& feedback, std::uint8_t counter, base::Time time);

  [[nodiscard]] const VehicleState& state() const { return state_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }  // incomplete or non-finite sets

 private:
  enum Part : unsigned { kPose = 1, kMotion = 2, kFeedback = 4, kAll = 7 };

  void Begin(Part part, std::uint8_t counter, base::Time time);
  [[nodiscard]] bool Finish(Part part);

  base::Time longest_;
  VehicleState state_;
  VehicleState next_;  // the incomplete set
  unsigned parts_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace loop
