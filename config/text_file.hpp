// The whole text of a file, and text made fit for a message of one line.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace config {

// Throws ConfigError "FILE: cannot be read: REASON".
[[nodiscard]] std::string ReadTextFile(const std::filesystem::path& file);

// `text` without control characters, cut after 80 bytes: an error stays on one line whatever stands in the
// file.
[[nodiscard]] std::string Printable(std::string_view text);

}  // namespace config
