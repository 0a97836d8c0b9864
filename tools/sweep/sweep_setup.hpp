// The definition of a sweep: everything on which its result depends, and which all of its parts must share.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/scenarios/scenario_ranges.hpp"
#include "tools/shards/shard.hpp"

namespace tools {

struct SweepSetup {
  std::uint64_t seed = 0;  // below kSeedEnd
  int count = 1;           // scenarios, >= 1
  ScenarioRanges ranges;
  std::vector<std::string> controllers;  // names, each once

  // "200 scenarios with traffic of seed 1, 8..20 m/s, mu 0.4..1, by lpv, nmpc"
  [[nodiscard]] std::string Describe() const;
  // "lpvmpc run --sweep-seed SEED --speed 8 20 --mu 0.4 1 --controller NAME"
  [[nodiscard]] std::string CommandToDriveAgain() const;
  bool operator==(const SweepSetup&) const = default;
};

// Throws std::invalid_argument, naming the command-line option, if a range is bad (scenario_ranges.hpp), or a
// controller is unknown or named twice, or none is named.
void CheckSetup(const SweepSetup& setup);

}  // namespace tools
