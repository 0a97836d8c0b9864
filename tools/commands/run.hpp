// `lpvmpc run`: a scenario driven by the daemon's control loop in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

struct RunOptions {
  std::filesystem::path scenario;           // empty: `sweep_seed` names one
  std::optional<std::uint64_t> sweep_seed;  // of a scenario of a sweep (tools/scenarios/random_scenario.hpp)
  ScenarioRanges ranges;                    // of that sweep
  std::filesystem::path config;  // of the daemon; empty: the one that the scenario names, or that of sweeps
  std::string controller;        // empty: the configuration's; of a sweep's scenario: lpv-affine
  std::filesystem::path log;     // candump log of every frame; empty: none
  std::filesystem::path out;  // folder for candump.log, summary.json, drive.toml and report.html; empty: none
  std::filesystem::path
      record_qp;  // folder for the controller's quadratic problems (tools/bench/qp_instance.hpp); empty: none
  bool json = false;
};

// Writes the summary to `out`. Returns 0 if the scenario's expectations are met, 1 if not. Throws one
// line at bad input, before anything is written, and if a file cannot be.
[[nodiscard]] int Run(const RunOptions& options, std::ostream& out);

}  // namespace tools
