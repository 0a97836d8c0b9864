#include "tools/sweep/sweep_setup.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

#include "tools/drive/sweep_config.hpp"

namespace tools {

std::string SweepSetup::Describe() const {
  return fmt::format("{} scenarios{} of seed {}, {}..{} m/s, mu {}..{}, by {}", count,
                     ranges.traffic ? " with traffic" : "", seed, ranges.speed.low, ranges.speed.high,
                     ranges.mu.low, ranges.mu.high, fmt::join(controllers, ", "));
}

std::string SweepSetup::CommandToDriveAgain() const {
  return fmt::format("lpvmpc run --sweep-seed SEED{} --speed {} {} --mu {} {} --controller NAME",
                     ranges.traffic ? " --traffic" : "", ranges.speed.low, ranges.speed.high, ranges.mu.low,
                     ranges.mu.high);
}

void CheckSetup(const SweepSetup& setup) {
  CheckRanges(setup.ranges);
  if (setup.controllers.empty()) throw std::invalid_argument("--controller: none is named");
  const std::vector<std::string> known = SweepControllers();
  for (auto name = setup.controllers.begin(); name != setup.controllers.end(); ++name) {
    if (std::ranges::find(known, *name) == known.end())
      throw std::invalid_argument(
          fmt::format("--controller: no \"{}\" in a sweep: {}", *name, fmt::join(known, ", ")));
    if (std::find(setup.controllers.begin(), name, *name) != name)
      throw std::invalid_argument(fmt::format("--controller: {} is named twice", *name));
  }
}

}  // namespace tools
