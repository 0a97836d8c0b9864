#include "tools/paper/feasibility_map.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "tools/io/process_pool.hpp"

namespace tools {
namespace {

using loop::ControllerKind;

constexpr std::array kControllers{ControllerKind::kLpvStandard, ControllerKind::kLpv, ControllerKind::kNmpc};
constexpr std::array kHorizons{8, 15};
constexpr int kSpeeds = 11;  // 10, 11, ... 20 m/s
constexpr int kShifts = 14;  // 0.1, 0.2, ... 1.4 m

double Speed(int i) {
  return 10.0 + i;
}

double Shift(int i) {
  return (i + 1) / 10.0;
}

}  // namespace

std::size_t MapDrives() {
  return kControllers.size() * kHorizons.size() * kSpeeds * kShifts;
}

FeasibilityMap MapFeasibility(int jobs, ProgressBar& bar) {
  bar.Name("map");
  std::vector<CircleDrive> drives;
  for (const ControllerKind controller : kControllers) {
    for (const int horizon : kHorizons) {
      for (int shift = 0; shift < kShifts; ++shift) {
        for (int speed = 0; speed < kSpeeds; ++speed) {
          drives.push_back(
              {.speed = Speed(speed), .shift = Shift(shift), .horizon = horizon, .controller = controller});
        }
      }
    }
  }
  const std::vector<std::string> outcomes = MapInProcesses(
      drives.size(), jobs, [&](std::size_t i) { return std::to_string(static_cast<int>(Drive(drives[i]))); },
      [&] { bar.Advance(); });

  FeasibilityMap map;
  for (int i = 0; i < kSpeeds; ++i) map.speeds.push_back(Speed(i));
  for (int i = 0; i < kShifts; ++i) map.shifts.push_back(Shift(i));
  std::size_t next = 0;
  for (const ControllerKind controller : kControllers) {
    for (const int horizon : kHorizons) {
      MapPanel panel{.controller = controller, .horizon = horizon, .cells = {}};
      panel.cells.assign(kShifts, std::vector<CircleOutcome>(kSpeeds));
      for (auto& row : panel.cells) {
        for (CircleOutcome& cell : row) cell = static_cast<CircleOutcome>(std::stoi(outcomes[next++]));
      }
      map.panels.push_back(std::move(panel));
    }
  }
  return map;
}

int MapPanel::clear() const {
  int count = 0;
  for (const auto& row : cells) count += static_cast<int>(std::ranges::count(row, CircleOutcome::kClear));
  return count;
}

std::optional<double> FeasibilityMap::Limit(const MapPanel& panel, std::size_t speed) const {
  std::optional<double> limit;
  for (std::size_t i = 0; i < shifts.size() && panel.cells[i][speed] == CircleOutcome::kClear; ++i)
    limit = shifts[i];
  return limit;
}

}  // namespace tools
