// `lpvmpc run`: drives a scenario with the daemon's control loop in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

struct RunOptions {
  std::filesystem::path scenario;           // empty: `sweep_seed` or `traffic_key` selects one
  std::optional<std::uint64_t> sweep_seed;  // seed of a scenario of a sweep (random_scenario.hpp)
  std::string traffic_key;                  // of a scenario with traffic (traffic_point.hpp)
  ScenarioRanges ranges;                    // ranges from which it was drawn
  // The daemon's configuration; empty: the one named by the scenario, or the sweeps' own.
  std::filesystem::path config;
  std::string controller;     // empty: that of the configuration, or lpv-affine for a drawn scenario
  std::filesystem::path log;  // candump log of every frame; empty: none
  std::filesystem::path out;  // folder for candump.log, summary.json, drive.toml and report.html; empty: none
  // Folder for the controller's quadratic problems (config/qp_file.hpp); empty: none.
  std::filesystem::path record_qp;
  bool json = false;

  [[nodiscard]] bool drawn() const { return sweep_seed || !traffic_key.empty(); }  // not from a file
};

// Writes each decision of the controller, in words and with its time since the first state, and the summary to `out`, or
// with `json` the summary alone. Returns 0 if the scenario's expectations are met, 1 if not. Throws an exception with a
// one-line message on bad input, before anything is written, and if a file cannot be written.
[[nodiscard]] int Run(const RunOptions& options, std::ostream& out);

}  // namespace tools
