// The map behind the ten scenarios: where each controller drives past an obstacle on a circular road, over speed, the
// sideways shift that the obstacle asks for, and the horizon.
#pragma once

#include <optional>
#include <vector>

#include "tools/io/progress_bar.hpp"
#include "tools/paper/circle_drive.hpp"

namespace tools {

struct MapPanel {
  loop::ControllerKind controller;
  int horizon;
  std::vector<std::vector<CircleOutcome>> cells;  // for each shift, for each speed

  [[nodiscard]] int clear() const;  // cells
};

struct FeasibilityMap {
  std::vector<double> speeds;  // [m/s]
  std::vector<double> shifts;  // [m]
  std::vector<MapPanel> panels;

  // The greatest shift up to which every cell of the panel at this speed is clear; none if the first is not.
  [[nodiscard]] std::optional<double> Limit(const MapPanel& panel, std::size_t speed) const;
};

[[nodiscard]] std::size_t MapDrives();  // how many drives the map takes

// In `jobs` processes at a time; the bar goes on by one for each drive. The map does not depend on `jobs`.
// Throws std::runtime_error: a process failed.
[[nodiscard]] FeasibilityMap MapFeasibility(int jobs, ProgressBar& bar);

}  // namespace tools
