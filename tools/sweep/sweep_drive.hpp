// A drive of one scenario of a sweep by one controller.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "can/frame.hpp"
#include "tools/scenarios/random_scenario.hpp"
#include "tools/sweep/sweep_outcome.hpp"

namespace tools {

// A figure that is not finite, because the drive diverged, is stored as none.
struct SweepDrive {
  SweepOutcome outcome = SweepOutcome::kFailed;
  std::string why;  // reason of the failure, and the first unsolved step; empty if there is neither
  std::int64_t steps = 0;
  int infeasible_steps = 0;
  int safe_stops = 0;
  std::optional<double> min_clearance_m;
  std::optional<double> min_road_margin_m;
  double longest_free_standstill_s = 0.0;
  std::optional<double> max_speed_excess_mps = {};
  std::optional<double> end_overshoot_m = {};
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

// `way`: what is possible in the scenario. Calls `frame` with every frame of both sides. Throws std::invalid_argument if
// there is no such controller.
[[nodiscard]] TimedSweepDrive DriveSweepScenario(
    const RandomScenario& drawn, PossibleWay way, const ScenarioRanges& ranges, const std::string& controller,
    const std::function<void(const can::Frame&)>& frame = nullptr);

}  // namespace tools
