// What a sweep is: all that its result depends on, and so what all of its parts must share.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

struct SweepSetup {
  std::uint64_t seed = 0;  // below kSeedEnd
  int count = 1;           // scenarios, >= 1
  ScenarioRanges ranges;
  std::vector<std::string> controllers;  // names, each once

  // "200 scenarios of seed 1, 8..20 m/s, mu 0.4..1, by lpv, nmpc"
  [[nodiscard]] std::string Describe() const;
  bool operator==(const SweepSetup&) const = default;
};

// Throws std::invalid_argument, in the words of the command line: a range (sweep_ranges.hpp), a controller that there is
// not, or one named twice, or none.
void CheckSetup(const SweepSetup& setup);

// Part `index`, from 1, of `of`: the scenarios index − 1, index − 1 + of, ...
struct Shard {
  int index = 1;
  int of = 1;
  bool operator==(const Shard&) const = default;

  [[nodiscard]] std::vector<int> Indices(int count) const;
};

// Of "i/n". Throws std::invalid_argument unless 1 <= i <= n.
[[nodiscard]] Shard ParseShard(const std::string& text);

}  // namespace tools
