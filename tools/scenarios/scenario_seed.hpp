// The seed of each scenario of a sweep.
#pragma once

#include <cstdint>

namespace tools {

// Seeds are below 2^53, so that every JSON reader preserves all of their digits.
inline constexpr std::uint64_t kSeedEnd = std::uint64_t{1} << 53;

// The seed of scenario `index`, from 0: the upper 53 bits of output number `index` of SplitMix64 (Steele, Lea, Flood:
// Fast Splittable Pseudorandom Number Generators, 2014) started at state `sweep_seed`. It does not depend on earlier
// scenarios.
[[nodiscard]] constexpr std::uint64_t ScenarioSeed(std::uint64_t sweep_seed, std::uint64_t index) {
  std::uint64_t mixed = sweep_seed + (index + 1) * 0x9e3779b97f4a7c15;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111eb;
  return (mixed ^ (mixed >> 31)) >> 11;
}

}  // namespace tools
