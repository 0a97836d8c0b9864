// The paper's first comparison (fig. LPV_comparison): ten drives on a circular road past an obstacle, with the standard
// LPVMPC and with the LPVMPC with scheduling trust region, all else equal.
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

  double largest_plan_change = 0.0;  // before the first unsolved step, if there is one [m]

  [[nodiscard]] bool feasible() const { return !figures.first_failure && figures.summary.completed; }
};

struct FeasibilityRow {
  std::string number;  // "01"
  std::string description;
  double speed = 0.0;  // [m/s]
  double shift = 0.0;  // sideways shift of the path that clears the obstacle [m]
  config::RouteFile road;
  FeasibilityDrive standard, trust_region;
};

inline constexpr int kFeasibilityScenarios = 10;

// Drives scenarios 01.toml to 10.toml of `folder` with both controllers; the bar advances by one per drive. Throws an
// exception with a one-line message if a file is missing or wrong, or if a controller never engages.
[[nodiscard]] std::vector<FeasibilityRow> CompareFeasibility(const std::filesystem::path& folder,
                                                             ProgressBar& bar);

}  // namespace tools
