// `lpvmpc report RUN_DIR -o FILE`: the page about a run, one HTML file that any browser shows without a network.
//
// RUN_DIR holds either
//   report.json   the page's data (report_page.hpp), as written by `lpvmpc paper --out` and `lpvmpc sweep --out`
// or, for a single drive, as written by `lpvmpc run --out` and scripts/drive,
//   candump.log   every frame of the bus
//   drive.toml    the drive's inputs (tools/drive/drive_file.hpp)
//   summary.json  its result (sim/summary.hpp), optional
#pragma once

#include <filesystem>

namespace tools {

struct ReportOptions {
  std::filesystem::path run_dir;
  std::filesystem::path output;
};

// Writes the complete page or nothing. Throws an exception with a one-line message if a file is missing, is wrong (the
// message names the place of the error) or cannot be written.
void Report(const ReportOptions& options);

}  // namespace tools
