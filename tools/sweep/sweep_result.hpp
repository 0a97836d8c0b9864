// The result of a sweep, or of a part of it.
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
  int index = 0;  // index in the sweep, from 0
  std::uint64_t seed = 0;
  std::string description;
  PossibleWay way = PossibleWay::kNone;
  std::vector<SweepDrive> drives;  // in the order of the setup's controllers
};

struct SweepResult {
  SweepSetup setup;
  std::vector<SweptScenario> scenarios;  // by increasing index
  std::vector<TimeHistogram> times;      // times of control steps, in the order of the controllers
};

// One line of the table.
struct ControllerFigures {
  std::string controller;
  std::array<int, kAllOutcomes.size()> outcomes{};  // scenarios by SweepOutcome
  int passed_of_passable = 0;                       // passed scenarios among those with PossibleWay::kPass
  int failures_of_possible = 0;                     // where passing or stopping is possible
  std::optional<double> cost_ratio = {};     // to the NMPC's cost; median over scenarios that both passed
  std::optional<double> steering_rate = {};  // median RMS over the drives that passed [rad/s]
  std::optional<double> jerk = {};           // median RMS over the drives that passed [m/s³]

  [[nodiscard]] int Count(SweepOutcome outcome) const { return outcomes[static_cast<std::size_t>(outcome)]; }
};

[[nodiscard]] std::vector<ControllerFigures> Tabulate(const SweepResult& result);
[[nodiscard]] int CountWays(const SweepResult& result, PossibleWay way);

// A failed drive, as indices into SweepResult.
struct SweepFailure {
  std::size_t scenario;
  std::size_t controller;
};
// All failures, in the order of the scenarios.
[[nodiscard]] std::vector<SweepFailure> Failures(const SweepResult& result);
// The `most` worst failures: first those where passing or stopping was possible; within each group, by increasing
// smallest clearance or road margin.
[[nodiscard]] std::vector<SweepFailure> WorstFailures(const SweepResult& result, std::size_t most);

// Text for a terminal.
[[nodiscard]] std::string ToText(const SweepResult& result);
// {"sweep", "table", "scenarios"}: reproducible, whatever the number of processes.
[[nodiscard]] nlohmann::ordered_json ToJson(const SweepResult& result);
// {"steps", "median_s", "p99_s"} for each controller: measured wall-clock times.
[[nodiscard]] nlohmann::ordered_json TimingJson(const SweepResult& result);
// The data of the sweep's page (report_page.hpp). Drives the worst failures again to plot them.
[[nodiscard]] nlohmann::ordered_json SweepPage(const SweepResult& result);

}  // namespace tools
