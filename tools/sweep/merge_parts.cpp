#include "tools/sweep/merge_parts.hpp"

#include <algorithm>
#include <iterator>

#include <nlohmann/json.hpp>

#include "tools/shards/read_parts.hpp"
#include "tools/sweep/sweep_json.hpp"

namespace tools {

SweepResult MergeParts(const std::vector<std::filesystem::path>& files) {
  std::vector<SweepPart> parts = ReadParts(files, "sweep", PartOf);
  SweepResult whole = std::move(parts.front().result);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    std::ranges::move(parts[i].result.scenarios, std::back_inserter(whole.scenarios));
    for (std::size_t c = 0; c < whole.times.size(); ++c) whole.times[c].Add(parts[i].result.times[c]);
  }
  std::ranges::sort(whole.scenarios, {}, &SweptScenario::index);
  return whole;
}

}  // namespace tools
