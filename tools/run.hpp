// `lpvmpc run`: a scenario driven by the daemon's control loop in memory.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

namespace tools {

struct RunOptions {
  std::filesystem::path scenario;
  std::filesystem::path config;  // of the daemon; empty: the one that the scenario names
  std::string controller;        // empty: the configuration's
  std::filesystem::path log;     // candump log of every frame; empty: none
  std::filesystem::path out;  // folder for candump.log, summary.json, drive.toml and report.html; empty: none
  bool json = false;
};

// Writes the summary to `out`. Returns 0 if the scenario's expectations are met, 1 if not. Throws one
// line at bad input, before the log is opened, and if a file cannot be written.
[[nodiscard]] int Run(const RunOptions& options, std::ostream& out);

}  // namespace tools
