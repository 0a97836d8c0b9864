// Files written by commands.
#pragma once

#include <filesystem>
#include <string_view>

namespace tools {

// Replaces the file completely or leaves it unchanged. Anything but a regular file (a pipe, a terminal) is written to
// directly; links are followed. Throws std::runtime_error "FILE: cannot be written: REASON".
void WriteFile(const std::filesystem::path& file, std::string_view text);

// Creates the folder and its parents. Throws std::runtime_error "FOLDER: cannot be created: REASON".
void MakeFolder(const std::filesystem::path& folder);

}  // namespace tools
