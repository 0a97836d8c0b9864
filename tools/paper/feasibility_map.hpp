// The map behind the ten scenarios: where each controller drives past an obstacle on a circular road, depending on
// speed, the sideways shift that the obstacle requires, and the horizon.
#pragma once

#include <optional>
#include <vector>

#include "tools/io/progress_bar.hpp"
#include "tools/paper/circle_drive.hpp"

namespace tools {

struct MapPanel {
  loop::ControllerKind controller;
  int horizon;
  std::vector<std::vector<CircleOutcome>> cells;  // cells[shift][speed]

  [[nodiscard]] int clear() const;  // number of clear cells
};

struct FeasibilityMap {
  std::vector<double> speeds;  // [m/s]
  std::vector<double> shifts;  // [m]
  std::vector<MapPanel> panels;

  // The greatest shift up to which every cell of the panel at this speed is clear; none if the first cell is not.
  [[nodiscard]] std::optional<double> Limit(const MapPanel& panel, std::size_t speed) const;
};

[[nodiscard]] std::size_t MapDrives();  // number of drives for the map

// Runs `jobs` processes at a time; the bar advances by one per drive. The map does not depend on `jobs`. Throws
// std::runtime_error if a process fails.
[[nodiscard]] FeasibilityMap MapFeasibility(int jobs, ProgressBar& bar);

}  // namespace tools
