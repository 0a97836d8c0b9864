// `lpvmpc sweep`: many random scenarios, driven by several controllers. docs/sweep.md is its manual.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <vector>

#include "tools/sweep/sweep_setup.hpp"

namespace tools {

struct SweepOptions {
  SweepSetup setup;
  int jobs = 1;                // processes
  std::optional<Shard> shard;  // none: the whole sweep
  // Folder for sweep.json, timing.json, report.json and report.html; with `shard`, the file for its part; empty: none.
  std::filesystem::path out;
  bool json = false;
};

// Writes the table, or with `json` all figures, to `out`; with `shard`, its part if no file is given. Throws an
// exception with a one-line message on a bad option, before anything is driven, or if a file cannot be written.
void Sweep(const SweepOptions& options, std::ostream& out);

struct SweepMergeOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path out;
  bool json = false;
};

// Writes the same output as the sweep without shards. Throws an exception with a one-line message that names the file
// if it is missing, is not a part, belongs to another sweep or repeats a shard, or that lists the missing shards.
void MergeSweep(const SweepMergeOptions& options, std::ostream& out);

}  // namespace tools
