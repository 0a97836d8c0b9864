// A drive of one scenario of a sweep by one controller, and its outcome.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "can/frame.hpp"
#include "tools/scenarios/random_scenario.hpp"

namespace tools {

enum class SweepOutcome {
  kPassed,   // reached the end of the route
  kStopped,  // came to a stop before it
  kContact,  // the vehicle's rectangle touched an obstacle and had not left the road before
  kOffRoad,  // a corner left the road before any contact
  kFailed,   // never engaged, taken over, or not at the end after twice the route's time plus 10 s
};
inline constexpr int kSweepOutcomes = 5;
[[nodiscard]] const char* NameOf(
    SweepOutcome outcome);  // "passed", "stopped", "contact", "off-road", "failed"
[[nodiscard]] constexpr bool IsFailure(SweepOutcome outcome) {
  return outcome != SweepOutcome::kPassed && outcome != SweepOutcome::kStopped;
}

// A figure that is not finite, because the drive diverged, is stored as none.
struct SweepDrive {
  SweepOutcome outcome = SweepOutcome::kFailed;
  std::string why;  // step of the failure, and the first unsolved step; empty if there is neither
  std::int64_t steps = 0;
  int infeasible_steps = 0;
  std::optional<double> min_clearance_m;
  std::optional<double> min_road_margin_m;
  // The cost with the default weights of control::MpcSettings and the reference beside the vehicle, for every
  // controller.
  std::optional<double> cost;
  std::optional<double> rms_steering_rate;  // [rad/s]
  std::optional<double> rms_jerk;           // [m/s³]
};

struct TimedSweepDrive {
  SweepDrive drive;
  std::vector<double> step_seconds;  // wall-clock time of each control step
};

// Calls `frame` with every frame of both sides. Throws std::invalid_argument if there is no such controller.
[[nodiscard]] TimedSweepDrive DriveSweepScenario(
    const RandomScenario& drawn, const ScenarioRanges& ranges, const std::string& controller,
    const std::function<void(const can::Frame&)>& frame = nullptr);

}  // namespace tools
