// One scenario of a sweep driven by one controller, and what came of it.
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
  kPassed,   // to the end of the route
  kStopped,  // came to a stop before it
  kContact,  // the vehicle's rectangle met an obstacle before it left the road; what came after does not count
  kOffRoad,  // a corner left the road first
  kFailed,   // none of these: never engaged, taken over on the way, or not there in twice the route's time
};
inline constexpr int kSweepOutcomes = 5;
[[nodiscard]] const char* NameOf(
    SweepOutcome outcome);  // "passed", "stopped", "contact", "off-road", "failed"
[[nodiscard]] constexpr bool IsFailure(SweepOutcome outcome) {
  return outcome != SweepOutcome::kPassed && outcome != SweepOutcome::kStopped;
}

// Figures that are not finite, of a drive that went beyond all bounds, are none.
struct SweepDrive {
  SweepOutcome outcome = SweepOutcome::kFailed;
  std::string why;  // when, and the first step that was not solved; empty if passed and all were
  std::int64_t steps = 0;
  int infeasible_steps = 0;
  std::optional<double> min_clearance_m;
  std::optional<double> min_road_margin_m;
  // By the default weights of control::MpcSettings and the road beside the vehicle, whoever drives.
  std::optional<double> cost;
  std::optional<double> rms_steering_rate;  // [rad/s]
  std::optional<double> rms_jerk;           // [m/s³]
};

struct TimedSweepDrive {
  SweepDrive drive;
  std::vector<double> step_seconds;  // of wall clock, one for each control step
};

// `frame` is called with every frame of both sides. Throws std::invalid_argument: no such controller.
[[nodiscard]] TimedSweepDrive DriveSweepScenario(
    const RandomScenario& drawn, const ScenarioRanges& ranges, const std::string& controller,
    const std::function<void(const can::Frame&)>& frame = nullptr);

}  // namespace tools
