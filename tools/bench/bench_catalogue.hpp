// `lpvmpc bench catalogue`: time of the whole control cycle, with planner, QP and the check of the plan, in every scenario
// of the catalogue, and whether it is within what is aimed at:
//
//   median ≤ 120 µs,  p99 ≤ 500 µs,  worst ≤ 1000 µs
//
// Posts beside the road (roadside_posts.hpp) fill the objects up to a number that is the same everywhere. What counts is
// the processor's time of the cycles in which the daemon commands; a drive is repeated, and as it is the same each time, the
// least of a cycle's times counts, so that whatever else the computer does does not.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

namespace tools {

struct BenchCatalogueOptions {
  std::filesystem::path folder;
  std::string filter;  // only scenarios whose name contains it
  int horizon = 40;    // N
  int objects = 32;    // 0..64; a scenario may have more of its own
  int repeat = 3;      // drives of each scenario
  bool json = false;
};

// Writes for each scenario the number of cycles, their median, p99 and maximum [µs], the largest wall-clock time of any cycle
// [µs], the time at which the slowest cycle was [s] and whether the drive with the added objects is as its scenario
// expects; likewise for all cycles together; and which scenario misses which aim. Throws an exception with a one-line message
// on bad input.
void BenchCatalogue(const BenchCatalogueOptions& options, std::ostream& out);

}  // namespace tools
