#include "tools/sweep/sweep_setup.hpp"

#include <algorithm>
#include <charconv>
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

std::vector<int> Shard::Indices(int count) const {
  std::vector<int> indices;
  for (int i = index - 1; i < count; i += of) indices.push_back(i);
  return indices;
}

Shard ParseShard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, shard.index);
  if (error == std::errc() && slash != end && *slash == '/') {
    const auto [rest, failure] = std::from_chars(slash + 1, end, shard.of);
    if (failure == std::errc() && rest == end && 1 <= shard.index && shard.index <= shard.of) return shard;
  }
  throw std::invalid_argument(fmt::format("--shard: {} must be i/n with 1 <= i <= n", text));
}

}  // namespace tools
