#include "tools/sweep/merge_parts.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "config/text_file.hpp"
#include "tools/sweep/sweep_json.hpp"

namespace tools {
namespace {

using Files = std::vector<std::filesystem::path>;

SweepPart ReadPart(const std::filesystem::path& file) {
  const std::string text = config::ReadTextFile(file);
  try {
    return PartOf(nlohmann::ordered_json::parse(text));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: is not a part of a sweep: {}", config::PlaceName(file),
                                         config::Printable(error.what(), 200)));
  }
}

void RefuseOther(const std::filesystem::path& file, const SweepPart& part,
                 const std::filesystem::path& first_file, const SweepPart& first) {
  const auto refuse = [&](const std::string& own, const std::string& other) {
    throw std::runtime_error(fmt::format("{}: is of another sweep than {}: {} instead of {}",
                                         config::PlaceName(file), config::PlaceName(first_file), own, other));
  };
  if (part.result.setup != first.result.setup)
    refuse(part.result.setup.Describe(), first.result.setup.Describe());
  if (part.shard.of != first.shard.of)
    refuse(fmt::format("{} shards", part.shard.of), std::to_string(first.shard.of));
}

}  // namespace

SweepResult MergeParts(const Files& files) {
  SweepPart whole = ReadPart(files.at(0));
  std::map<int, std::filesystem::path> shards{{whole.shard.index, files[0]}};
  for (std::size_t i = 1; i < files.size(); ++i) {
    SweepPart part = ReadPart(files[i]);
    RefuseOther(files[i], part, files[0], whole);
    const auto [before, added] = shards.try_emplace(part.shard.index, files[i]);
    if (!added) {
      throw std::runtime_error(fmt::format("{}: is shard {}/{}, as {} is", config::PlaceName(files[i]),
                                           part.shard.index, part.shard.of,
                                           config::PlaceName(before->second)));
    }
    std::ranges::move(part.result.scenarios, std::back_inserter(whole.result.scenarios));
    for (std::size_t c = 0; c < part.result.times.size(); ++c)
      whole.result.times[c].Add(part.result.times[c]);
  }
  std::string lacking;
  for (int index = 1; index <= whole.shard.of; ++index) {
    if (!shards.contains(index))
      lacking += fmt::format("{}{}/{}", lacking.empty() ? "" : ", ", index, whole.shard.of);
  }
  if (!lacking.empty()) {
    throw std::runtime_error(
        fmt::format("{}: no file is shard {} of its sweep", config::PlaceName(files[0]), lacking));
  }
  std::ranges::sort(whole.result.scenarios, {}, &SweptScenario::index);
  return whole.result;
}

}  // namespace tools
