// `lpvmpc bench step`: time of the whole control step (reference window, LPV matrices, QP, plan) along a drive.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace tools {

struct BenchStepOptions {
  std::filesystem::path scenario;
  std::filesystem::path config;  // of the daemon; empty: the one that the scenario names
  std::string controller;        // empty: the configuration's
  std::vector<int> horizons{8, 15, 40, 80, 200};
  int repeat = 5;  // drives per horizon
  bool json = false;
};

// Writes median, p99 and maximum in µs and the mean of the solver's iterations for each horizon, and of several the
// exponent of N with which the median grows. Throws one line at bad input, before anything is written.
void BenchStep(const BenchStepOptions& options, std::ostream& out);

}  // namespace tools
