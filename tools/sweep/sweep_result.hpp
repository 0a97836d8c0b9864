// What came of a sweep, or of a part of it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/scenarios/possible_way.hpp"
#include "tools/sweep/sweep_drive.hpp"
#include "tools/sweep/sweep_setup.hpp"
#include "tools/sweep/time_histogram.hpp"

namespace tools {

struct SweptScenario {
  int index = 0;  // in the sweep, from 0
  std::uint64_t seed = 0;
  std::string description;
  PossibleWay way = PossibleWay::kNone;
  std::vector<SweepDrive> drives;  // in the order of the setup's controllers
};

struct SweepResult {
  SweepSetup setup;
  std::vector<SweptScenario> scenarios;  // by rising index
  std::vector<TimeHistogram> times;      // of control steps, in the order of the controllers
};

// A line of the table.
struct ControllerFigures {
  std::string controller;
  std::array<int, kSweepOutcomes> outcomes{};  // scenarios by SweepOutcome
  int passed_of_passable = 0;                  // of those that PossibleWay::kPass says of
  int failures_of_possible = 0;           // contact, off-road, failed where there is a way to pass or to stop
  std::optional<double> cost_ratio = {};  // to the NMPC's, median over the scenarios that both passed
  std::optional<double> steering_rate = {};  // RMS of each drive that passed, their median [rad/s]
  std::optional<double> jerk = {};           // likewise [m/s³]
};

[[nodiscard]] std::vector<ControllerFigures> Tabulate(const SweepResult& result);
[[nodiscard]] int CountWays(const SweepResult& result, PossibleWay way);

// A drive that ended badly; indices into SweepResult.
struct SweepFailure {
  std::size_t scenario;
  std::size_t controller;
};
// In the order of the scenarios.
[[nodiscard]] std::vector<SweepFailure> Failures(const SweepResult& result);
// The `most` worst: where there was a way first, deepest first.
[[nodiscard]] std::vector<SweepFailure> WorstFailures(const SweepResult& result, std::size_t most);

// For a terminal.
[[nodiscard]] std::string ToText(const SweepResult& result);
// {"sweep", "table", "scenarios"}: the same whenever and by however many processes the sweep was driven.
[[nodiscard]] nlohmann::ordered_json ToJson(const SweepResult& result);
// For each controller {"steps", "median_s", "p99_s"}: what the clock of the machine said.
[[nodiscard]] nlohmann::ordered_json TimingJson(const SweepResult& result);
// The data of its page (report_page.hpp). Drives the worst failures again, to draw them.
[[nodiscard]] nlohmann::ordered_json SweepPage(const SweepResult& result);

}  // namespace tools
