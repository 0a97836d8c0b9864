// The definition of a falsification: everything on which its result depends, and which all of its parts must share.
#pragma once

#include <cstdint>
#include <string>

#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

// A search is of at most this many generations of drives; then another one begins afresh.
inline constexpr int kGeneration = 100, kGenerations = 20, kElite = 10;
inline constexpr int kDrivesOfSearch = kGeneration * kGenerations;

struct FalsifySetup {
  std::uint64_t seed = 0;  // below kSeedEnd
  int budget = 1;          // drives of all searches, >= 1
  ScenarioRanges ranges{.traffic = true};
  std::string controller = "lpv-affine";

  [[nodiscard]] int Searches() const { return (budget + kDrivesOfSearch - 1) / kDrivesOfSearch; }
  [[nodiscard]] int DrivesOf(int search) const;  // all but the last have kDrivesOfSearch
  // "5000 drives of seed 1 in 3 searches, 8..20 m/s, mu 0.4..1, by lpv-affine"
  [[nodiscard]] std::string Describe() const;
  // "lpvmpc run --speed 8 20 --mu 0.4 1 --controller lpv-affine --traffic-key KEY"
  [[nodiscard]] std::string CommandToDriveAgain(const std::string& key) const;
  bool operator==(const FalsifySetup&) const = default;
};

// Throws std::invalid_argument, naming the command-line option, if a range is bad (scenario_ranges.hpp) or the controller
// unknown.
void CheckSetup(const FalsifySetup& setup);

}  // namespace tools
