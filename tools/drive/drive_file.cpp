#include "tools/drive/drive_file.hpp"

#include <fmt/format.h>
#include <stdexcept>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/toml_table.hpp"
#include "tools/drive/sweep_config.hpp"
#include "tools/io/write_file.hpp"
#include "tools/scenarios/random_scenario.hpp"
#include "tools/scenarios/scenario_seed.hpp"
#include "tools/scenarios/traffic_scenario.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

constexpr const char* kSweepSeed = "sweep_seed";
constexpr const char* kTrafficKey = "traffic_key";

RandomScenario Drawn(const config::TomlTable& table, const ScenarioRanges& ranges) {
  if (table.Has(kTrafficKey)) return DrawTraffic(PointOf(table.Text(kTrafficKey)), ranges);
  return DrawScenario(
      static_cast<std::uint64_t>(table.Number(kSweepSeed, {0.0, static_cast<double>(kSeedEnd - 1)})), ranges);
}

DriveFile LoadDrawnDrive(const config::TomlTable& table) {
  const auto interval = [&](const char* key) {
    const std::vector<double> ends = table.Numbers(key, 2);
    return Interval{.low = ends[0], .high = ends[1]};
  };
  const ScenarioRanges ranges{.speed = interval("speed"),
                              .mu = interval("mu"),
                              .traffic = !table.Has(kTrafficKey) && table.BooleanOr("traffic", false)};
  const std::string controller = table.Text("controller");
  try {
    CheckRanges(ranges);
    const RandomScenario drawn = Drawn(table, ranges);
    table.RefuseUnknownKeys();
    return {.scenario = drawn.scenario, .config = ConfigFor(controller, ranges), .road = drawn.route};
  } catch (const std::invalid_argument& error) {
    throw table.Error(table.Has(kTrafficKey) ? kTrafficKey : kSweepSeed, error.what());
  }
}

// The keys of a drawn scenario's ranges, and the controller.
std::string TextOf(const ScenarioRanges& ranges, const std::string& controller) {
  const auto interval = [](const Interval& range) {
    return ordered_json{range.low, range.high}.dump();  // as in TOML
  };
  return fmt::format("speed = {}\nmu = {}\ncontroller = \"{}\"\n", interval(ranges.speed),
                     interval(ranges.mu), controller);
}

}  // namespace

DriveFile LoadDriveFile(const std::filesystem::path& file) {
  const config::TomlTable table = config::TomlTable::Read(file);
  if (table.Has(kSweepSeed) || table.Has(kTrafficKey)) return LoadDrawnDrive(table);
  const sim::Scenario scenario = sim::LoadScenario(table.Path("scenario"));
  const loop::Config config = loop::LoadConfig(table.Path("config"));
  DriveFile drive{.scenario = scenario, .config = config, .road = config::LoadRoute(config.route)};
  if (table.Has("controller")) {
    try {
      loop::SelectController(drive.config, table.Text("controller"));
    } catch (const std::invalid_argument& error) {
      throw table.Error("controller", error.what());
    }
  }
  table.RefuseUnknownKeys();
  return drive;
}

void WriteDriveFile(const std::filesystem::path& run_dir, const std::filesystem::path& scenario,
                    const std::filesystem::path& config, const std::string& controller) {
  const auto quoted = [](const std::string& text) { return ordered_json(text).dump(); };  // as in TOML
  const auto path = [&](const std::filesystem::path& file) {
    return quoted(std::filesystem::absolute(file).lexically_normal().string());
  };
  std::string text = "# Inputs of this drive.\n";
  text += "scenario = " + path(scenario) + "\nconfig = " + path(config) +
          "\ncontroller = " + quoted(controller) + "\n";
  WriteFile(run_dir / "drive.toml", text);
}

void WriteSweepDriveFile(const std::filesystem::path& run_dir, std::uint64_t seed,
                         const ScenarioRanges& ranges, const std::string& controller) {
  WriteFile(run_dir / "drive.toml",
            fmt::format("# A scenario of a sweep.\n{} = {}\ntraffic = {}\n{}", kSweepSeed, seed,
                        ranges.traffic, TextOf(ranges, controller)));
}

void WriteTrafficDriveFile(const std::filesystem::path& run_dir, const std::string& key,
                           const ScenarioRanges& ranges, const std::string& controller) {
  WriteFile(run_dir / "drive.toml", fmt::format("# A scenario with traffic.\n{} = \"{}\"\n{}", kTrafficKey,
                                                key, TextOf(ranges, controller)));
}

}  // namespace tools
