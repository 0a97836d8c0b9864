// `lpvmpc report RUN_DIR -o FILE`: the page about a run, one HTML file that any browser opens without a network.
//
// RUN_DIR holds either
//   report.json   what the page shows (report_page.hpp), as `lpvmpc paper --out` writes it
// or, of a single drive, as `lpvmpc run --out` and scripts/drive write them,
//   candump.log   every frame of the bus
//   drive.toml    what it was driven with (tools/drive/drive_file.hpp)
//   summary.json  what came of it (sim/summary.hpp), if it is there
#pragma once

#include <filesystem>

namespace tools {

struct ReportOptions {
  std::filesystem::path run_dir;
  std::filesystem::path output;
};

// Writes the page, whole or not at all. Throws one line: a file is missing, wrong (with its line) or cannot be written.
void Report(const ReportOptions& options);

}  // namespace tools
