// Reads the parts that the shards of one command wrote, and refuses what does not make up the whole.
#pragma once

#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/text_file.hpp"
#include "tools/shards/shard.hpp"

namespace tools {

// A part has `shard` and `result.setup`, which can be compared and described. `what`: whose part it is: "sweep". `parse`
// makes a part of a file's JSON and throws an exception if it is none. `files` must not be empty.
//
// Throws std::runtime_error that names the file if it cannot be read, is not a part, belongs to another setup than the
// first, or repeats a shard; and one that lists the missing shards.
template <typename Part>
[[nodiscard]] std::vector<Part> ReadParts(const std::vector<std::filesystem::path>& files,
                                          const std::string& what,
                                          Part (*parse)(const nlohmann::ordered_json&)) {
  const auto read = [&](const std::filesystem::path& file) {
    const std::string text = config::ReadTextFile(file);
    try {
      return parse(nlohmann::ordered_json::parse(text));
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("{}: is not a part of a {}: {}", config::PlaceName(file), what,
                                           config::Printable(error.what(), 200)));
    }
  };
  std::vector<Part> parts;
  std::map<int, std::filesystem::path> shards;
  for (const std::filesystem::path& file : files) {
    parts.push_back(read(file));
    const Part &first = parts.front(), &part = parts.back();
    const auto refuse = [&](const std::string& own, const std::string& other) {
      throw std::runtime_error(fmt::format("{}: is of another {} than {}: {} instead of {}",
                                           config::PlaceName(file), what, config::PlaceName(files.front()),
                                           own, other));
    };
    if (part.result.setup != first.result.setup)
      refuse(part.result.setup.Describe(), first.result.setup.Describe());
    if (part.shard.of != first.shard.of)
      refuse(fmt::format("{} shards", part.shard.of), std::to_string(first.shard.of));
    const auto [before, added] = shards.try_emplace(part.shard.index, file);
    if (!added) {
      throw std::runtime_error(fmt::format("{}: is shard {}/{}, as {} is", config::PlaceName(file),
                                           part.shard.index, part.shard.of,
                                           config::PlaceName(before->second)));
    }
  }
  std::string lacking;
  const int of = parts.front().shard.of;
  for (int index = 1; index <= of; ++index) {
    if (!shards.contains(index)) lacking += fmt::format("{}{}/{}", lacking.empty() ? "" : ", ", index, of);
  }
  if (!lacking.empty()) {
    throw std::runtime_error(
        fmt::format("{}: no file is shard {} of its {}", config::PlaceName(files.front()), lacking, what));
  }
  return parts;
}

}  // namespace tools
