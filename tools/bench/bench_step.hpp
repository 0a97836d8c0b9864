// `lpvmpc bench step`: time of the whole control step (reference window, LPV matrices, QP, plan) along a drive.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace tools {

struct BenchStepOptions {
  std::filesystem::path scenario;
  std::filesystem::path config;  // the daemon's configuration; empty: that named by the scenario
  std::string controller;        // empty: that of the configuration
  std::vector<int> horizons{8, 15, 40, 80, 200};
  int repeat = 5;  // drives per horizon
  bool json = false;
};

// Writes median, p99 and maximum [µs], the mean of the solver's iterations and the number of unsolved steps for each
// horizon; with several horizons, also the exponent p of median ~ N^p. On bad input, throws an exception with a
// one-line message before anything is written.
void BenchStep(const BenchStepOptions& options, std::ostream& out);

}  // namespace tools
