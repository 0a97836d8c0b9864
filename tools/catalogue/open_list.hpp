// The scenarios of a catalogue that are known not to meet their expectations: the file open.txt in the catalogue's
// folder, one line each, "NNN-name: what fails".
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace tools {

// What fails, by the name of the scenario's folder. Without the file, none is open. Throws std::runtime_error
// "FILE:LINE: REASON" if a line has no reason, repeats a scenario or names a folder that does not exist;
// config::ConfigError if the file cannot be read.
[[nodiscard]] std::map<std::string, std::string> LoadOpenList(const std::filesystem::path& catalogue);

}  // namespace tools
