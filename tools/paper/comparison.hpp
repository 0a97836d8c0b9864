// The paper's second comparison (tab. SC1, SC2, SC1_obs, SC2_obs): LPVMPC with trust region against NMPC in two tracking
// and two obstacle scenarios, each with its own weights, on the same road and plant.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/drive/drive_figures.hpp"
#include "tools/drive/drive_record.hpp"
#include "tools/io/progress_bar.hpp"

namespace tools {

// Of the control steps of a drive [s].
struct StepTimes {
  double average = 0.0;
  double maximum = 0.0;
  double minimum = 0.0;
};

struct ComparedDrive {
  DriveFigures figures;
  StepTimes times;
  DriveRecord record;
  loop::Config config;
};

struct ComparisonRow {
  std::string name;  // "tracking-1"
  std::string description;
  bool has_obstacle = false;
  config::RouteFile road;
  StepTimes paper_nmpc, paper_lpv;
  ComparedDrive nmpc, lpv;

  // How many times faster the LPVMPC is, by the average.
  [[nodiscard]] double speedup() const { return nmpc.times.average / lpv.times.average; }
  // By how much dearer the LPVMPC's drive is than the NMPC's, by the NMPC's weights; 0.1: a tenth.
  [[nodiscard]] double cost_gap() const { return lpv.figures.cost / nmpc.figures.cost - 1.0; }
};

inline constexpr int kComparisons = 4;

// Drives tracking-1, tracking-2, obstacle-1 and obstacle-2 of `folder` with both controllers, `repeat` times. A step's
// time is the least of its repetitions: what it takes where the machine does nothing else. The bar goes on by one for
// each drive. Throws one line: a file is missing or wrong.
[[nodiscard]] std::vector<ComparisonRow> CompareWithNmpc(const std::filesystem::path& folder, int repeat,
                                                         ProgressBar& bar);

}  // namespace tools
