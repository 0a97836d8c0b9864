// drive.toml: the inputs of a recorded drive, so that it can be shown and driven again.
//
//   scenario = "…", config = "…"        files; relative paths are relative to this file
//   controller = "…"                    optional; replaces that of the configuration
//
// or, for a scenario of a sweep,
//
//   sweep_seed = …, traffic = false, speed = [LO, HI], mu = [LO, HI], controller = "…"
//
// or, for one with traffic that has a key (tools/scenarios/traffic_point.hpp),
//
//   traffic_key = "…", speed = [LO, HI], mu = [LO, HI], controller = "…"
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "config/route_file.hpp"
#include "loop/config.hpp"
#include "sim/scenario.hpp"
#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

struct DriveFile {
  sim::Scenario scenario;
  loop::Config config;
  config::RouteFile road;
};

// Throws config::ConfigError with file, line and key if the file, or one that it names, is missing or wrong.
[[nodiscard]] DriveFile LoadDriveFile(const std::filesystem::path& file);

// Each writes drive.toml into the folder of a run and throws std::runtime_error if it cannot be written.
void WriteDriveFile(const std::filesystem::path& run_dir, const std::filesystem::path& scenario,
                    const std::filesystem::path& config, const std::string& controller);
void WriteSweepDriveFile(const std::filesystem::path& run_dir, std::uint64_t seed,
                         const ScenarioRanges& ranges, const std::string& controller);
void WriteTrafficDriveFile(const std::filesystem::path& run_dir, const std::string& key,
                           const ScenarioRanges& ranges, const std::string& controller);

}  // namespace tools
