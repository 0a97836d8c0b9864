// Reads whole text files, and makes text fit for a one-line message.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace config {

// Both throw ConfigError "FILE: cannot be read: REASON".
[[nodiscard]] std::ifstream OpenTextFile(const std::filesystem::path& file);
[[nodiscard]] std::string ReadTextFile(const std::filesystem::path& file);

// Returns `text` with '?' for control characters, cut after `longest` bytes, so that an error stays on one line
// whatever the file contains.
[[nodiscard]] std::string Printable(std::string_view text, std::size_t longest = 80);
// The file name with which an error begins; never cut.
[[nodiscard]] std::string PlaceName(const std::filesystem::path& file);

}  // namespace config
