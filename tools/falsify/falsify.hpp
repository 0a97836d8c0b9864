// `lpvmpc falsify`: searches for the scenarios with traffic in which a controller comes nearest to a contact by its own
// fault or to the road's edge. docs/sweep.md is its manual.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <vector>

#include "tools/falsify/falsify_result.hpp"

namespace tools {

// Makes the searches of the shard, with `jobs` processes at a time and a progress bar on stderr. The result does not
// depend on `jobs`. Throws std::runtime_error if a process fails.
[[nodiscard]] FalsifyPart RunSearches(const FalsifySetup& setup, const Shard& shard, int jobs);

struct FalsifyOptions {
  FalsifySetup setup;
  int jobs = 1;                // processes
  std::optional<Shard> shard;  // none: the whole
  std::filesystem::path out;   // file for all figures as JSON; with `shard`, for its part; empty: none
  int worst = 10;              // how many are printed
  bool json = false;
};

// Writes the text, or with `json` all figures, to `out`; with `shard`, its part if no file is given. Throws an exception
// with a one-line message on a bad option, before anything is driven, or if a file cannot be written.
void Falsify(const FalsifyOptions& options, std::ostream& out);

struct FalsifyMergeOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path out;
  int worst = 10;
  bool json = false;
};

// Writes the same output as without shards. Throws an exception with a one-line message that names the file if it is
// missing, is not a part, belongs to another setup or repeats a shard, or that lists the missing shards.
void MergeFalsify(const FalsifyMergeOptions& options, std::ostream& out);

}  // namespace tools
