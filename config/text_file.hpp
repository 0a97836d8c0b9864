// The whole text of a file, and text made fit for a message of one line.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace config {

// Both throw ConfigError "FILE: cannot be read: REASON".
[[nodiscard]] std::ifstream OpenTextFile(const std::filesystem::path& file);
[[nodiscard]] std::string ReadTextFile(const std::filesystem::path& file);

// `text` without control characters, cut after `longest` bytes: an error stays on one line whatever stands in the
// file.
[[nodiscard]] std::string Printable(std::string_view text, std::size_t longest = 80);
// The name of a file as it begins an error: whole.
[[nodiscard]] std::string PlaceName(const std::filesystem::path& file);

}  // namespace config
