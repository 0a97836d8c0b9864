// `lpvmpc report RUN_DIR -o FILE`: the page about a run, one HTML file that any browser opens without a network.
//
// RUN_DIR holds either
//   report.json   what the page shows (report_page.hpp), as `lpvmpc paper --out` writes it
// or, of a single drive, as `lpvmpc run --out` and scripts/drive write them,
//   candump.log   every frame of the bus
//   drive.toml    scenario = "…", config = "…": the files that it was driven with, relative paths relative to it;
//                 controller = "…" if it was not the configuration's;
//                 or of a scenario of a sweep sweep_seed = …, speed = [LO, HI], mu = [LO, HI], controller = "…"
//   summary.json  what came of it (sim/summary.hpp), if it is there
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

struct ReportOptions {
  std::filesystem::path run_dir;
  std::filesystem::path output;
};

// Writes the page, whole or not at all. Throws one line: a file is missing, wrong (with its line) or cannot be written.
void Report(const ReportOptions& options);

// Writes drive.toml. Throws std::runtime_error: it cannot be written.
void WriteDriveFile(const std::filesystem::path& run_dir, const std::filesystem::path& scenario,
                    const std::filesystem::path& config, const std::string& controller);
void WriteSweepDriveFile(const std::filesystem::path& run_dir, std::uint64_t seed,
                         const ScenarioRanges& ranges, const std::string& controller);

}  // namespace tools
