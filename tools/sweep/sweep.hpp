// `lpvmpc sweep`: many scenarios drawn by chance, driven by several controllers. docs/sweep.md is its manual.
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
  std::filesystem::path
      out;  // folder for sweep.json, timing.json, report.json and report.html; of a shard, the file
            // of its part; empty: none
  bool json = false;
};

// Writes the table, or with `json` all figures, to `out`; of a shard, its part if no file is given. Throws one line: a
// bad option, before anything is driven, or a file that cannot be written.
void Sweep(const SweepOptions& options, std::ostream& out);

struct SweepMergeOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path out;
  bool json = false;
};

// Writes what the sweep that the parts are of would have written without shards. Throws one line that names the file: it
// is missing, no part, of another sweep, there twice; or which shards are lacking.
void MergeSweep(const SweepMergeOptions& options, std::ostream& out);

}  // namespace tools
