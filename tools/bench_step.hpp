// `lpvmpc bench step`: time of the whole control step (reference window, LPV matrices, QP, plan) along a drive.
#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

namespace tools {

struct BenchStepOptions {
  std::filesystem::path scenario;
  std::filesystem::path config;  // of the daemon; empty: the one that the scenario names
  std::vector<int> horizons{8, 15};
  int repeat = 5;  // drives per horizon
  bool json = false;
};

// Writes median, p99 and maximum in µs and the mean of the solver's iterations for each horizon. Throws one line
// at bad input, before anything is written.
void BenchStep(const BenchStepOptions& options, std::ostream& out);

}  // namespace tools
