#include "tools/falsify/falsify_setup.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>
#include <vector>

#include "tools/drive/sweep_config.hpp"

namespace tools {

int FalsifySetup::DrivesOf(int search) const {
  return std::min(kDrivesOfSearch, budget - search * kDrivesOfSearch);
}

std::string FalsifySetup::Describe() const {
  return fmt::format("{} drive{} of seed {} in {} search{}, {}..{} m/s, mu {}..{}, by {}", budget,
                     budget == 1 ? "" : "s", seed, Searches(), Searches() == 1 ? "" : "es", ranges.speed.low,
                     ranges.speed.high, ranges.mu.low, ranges.mu.high, controller);
}

std::string FalsifySetup::CommandToDriveAgain(const std::string& key) const {
  return fmt::format("lpvmpc run --speed {} {} --mu {} {} --controller {} --traffic-key {}", ranges.speed.low,
                     ranges.speed.high, ranges.mu.low, ranges.mu.high, controller, key);
}

void CheckSetup(const FalsifySetup& setup) {
  CheckRanges(setup.ranges);
  const std::vector<std::string> known = SweepControllers();
  if (std::ranges::find(known, setup.controller) == known.end()) {
    throw std::invalid_argument(
        fmt::format("--controller: no \"{}\" here: {}", setup.controller, fmt::join(known, ", ")));
  }
}

}  // namespace tools
