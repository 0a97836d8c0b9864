// Files written by commands.
#pragma once

#include <filesystem>
#include <string_view>

namespace tools {

// Writes the file whole or leaves it as it was; what is no regular file (a pipe, a terminal) is written to as it is, and a
// link is followed. Throws std::runtime_error "FILE: cannot be written: REASON".
void WriteFile(const std::filesystem::path& file, std::string_view text);

// With the folders above it. Throws std::runtime_error "FOLDER: cannot be created: REASON".
void MakeFolder(const std::filesystem::path& folder);

}  // namespace tools
