// The data of the page about a single drive (report_page.hpp).
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

namespace tools {

// `run_dir` holds candump.log, drive.toml and optionally summary.json. Throws an exception with a one-line message if a
// file is missing or wrong.
[[nodiscard]] nlohmann::ordered_json DrivePage(const std::filesystem::path& run_dir);

// Reads a JSON file. Throws std::runtime_error with the file and the place of the error.
[[nodiscard]] nlohmann::ordered_json ParseJson(const std::filesystem::path& file);

}  // namespace tools
