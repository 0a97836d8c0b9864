// The paper's second comparison (tab. SC1, SC2, SC1_obs, SC2_obs): LPVMPC with trust region against NMPC in two
// tracking and two obstacle scenarios, each with its own weights, on the same road and plant.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/drive/drive_figures.hpp"
#include "tools/drive/drive_record.hpp"
#include "tools/io/progress_bar.hpp"

namespace tools {

// Times of the control steps of a drive [s].
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

  // Factor by which the LPVMPC is faster on average.
  [[nodiscard]] double speedup() const { return nmpc.times.average / lpv.times.average; }
  // Relative excess of the LPVMPC's cost over the NMPC's, with the NMPC's weights; 0.1 is 10 %.
  [[nodiscard]] double cost_gap() const { return lpv.figures.cost / nmpc.figures.cost - 1.0; }
};

inline constexpr int kComparisons = 4;

// Drives tracking-1, tracking-2, obstacle-1 and obstacle-2 of `folder` with both controllers, `repeat` times each. A
// step's time is the least of its repetitions, an estimate of the time on an otherwise idle machine. The bar advances
// by one per drive. Throws an exception with a one-line message if a file is missing or wrong, or if a controller never
// engages.
[[nodiscard]] std::vector<ComparisonRow> CompareWithNmpc(const std::filesystem::path& folder, int repeat,
                                                         ProgressBar& bar);

}  // namespace tools
