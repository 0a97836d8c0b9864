// The paper's first comparison (fig. LPV_comparison): ten drives on a circular road past an obstacle, by the standard
// LPVMPC and by the one with the scheduling trust region, all else equal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/drive/drive_figures.hpp"
#include "tools/drive/drive_record.hpp"
#include "tools/io/progress_bar.hpp"

namespace tools {

struct FeasibilityDrive {
  DriveFigures figures;
  DriveRecord record;
  loop::Config config;

  double largest_plan_change = 0.0;  // before the first infeasible step, if there is one [m]

  [[nodiscard]] bool feasible() const { return !figures.first_failure && figures.summary.completed; }
};

struct FeasibilityRow {
  std::string number;  // "01"
  std::string description;
  double speed = 0.0;  // [m/s]
  double shift = 0.0;  // by which the path has to give way to clear the obstacle [m]
  config::RouteFile road;
  FeasibilityDrive standard, trust_region;
};

inline constexpr int kFeasibilityScenarios = 10;

// Drives scenarios 01.toml to 10.toml of `folder`, both controllers; the bar goes on by one for each drive. Throws one
// line: a file is missing or wrong.
[[nodiscard]] std::vector<FeasibilityRow> CompareFeasibility(const std::filesystem::path& folder,
                                                             ProgressBar& bar);

}  // namespace tools
