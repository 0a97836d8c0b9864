#include "tools/catalogue/drive_catalogue.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "config/text_file.hpp"
#include "loop/assembly.hpp"
#include "sim/scenario.hpp"
#include "sim/summary.hpp"
#include "tools/catalogue/catalogue_page.hpp"
#include "tools/catalogue/open_list.hpp"
#include "tools/drive/closed_loop.hpp"
#include "tools/drive/drive_record.hpp"
#include "tools/drive/scenario_config.hpp"
#include "tools/io/process_pool.hpp"
#include "tools/io/progress_bar.hpp"

namespace tools {
namespace {

// What a child process hands to its parent.
std::string DriveOne(const std::filesystem::path& file, bool shown) {
  const sim::Scenario scenario = sim::LoadScenario(file);
  loop::Config config = LoadConfigFor(scenario, file, {});
  config.loop.send_horizon = config.loop.send_horizon || shown;  // the page shows plans
  const config::RouteFile route = config::LoadRoute(config.route);
  std::optional<bus::VehicleBus> bus;
  std::optional<DriveRecorder> recorder;
  ClosedLoopHooks hooks;
  if (shown) {
    recorder.emplace(bus.emplace(loop::OpenBus(config)), config.mpc.t_s);
    hooks.frame = [&recorder](const can::Frame& frame) { recorder->Take(frame); };
  }
  const sim::Summary summary = DriveClosedLoop(scenario, config, route, hooks);
  const std::string part =
      shown ? ShownDrive(recorder->record(), scenario, config, route, summary).dump() : "";
  return nlohmann::json{{"description", scenario.description},
                        {"duration", static_cast<double>(summary.steps) * config.mpc.t_s},
                        {"summary", sim::ToJson(summary)},
                        {"shown", part}}
      .dump();
}

CatalogueOutcome OutcomeOf(bool passed, bool open) {
  if (passed) return open ? CatalogueOutcome::kNoLongerOpen : CatalogueOutcome::kPassed;
  return open ? CatalogueOutcome::kOpen : CatalogueOutcome::kFailed;
}

CatalogueDrive ReadDrive(const std::string& name, const std::string& text,
                         const std::map<std::string, std::string>& open) {
  const nlohmann::json json = nlohmann::json::parse(text);
  CatalogueDrive drive;
  drive.name = name;
  drive.description = json.at("description");
  drive.open = open.contains(name) ? open.at(name) : "";
  drive.summary = json.at("summary");
  drive.duration = json.at("duration");
  drive.shown = json.at("shown");
  const nlohmann::json summary = nlohmann::json::parse(drive.summary);
  const auto figure = [&summary](const char* key) -> std::optional<double> {
    const nlohmann::json& value = summary.at(key);
    return value.is_null() ? std::nullopt : std::optional(value.get<double>());
  };
  drive.outcome = OutcomeOf(summary.at("passed"), open.contains(name));
  drive.failed_expectations = summary.at("failed_expectations");
  drive.min_clearance_m = figure("min_clearance_m");
  drive.min_road_margin_m = figure("min_road_margin_m");
  drive.longest_free_standstill_s = summary.at("longest_free_standstill_s");
  drive.max_speed_excess_mps = figure("max_speed_excess_mps");
  drive.rms_steering_rate = figure("rms_steering_rate");
  return drive;
}

}  // namespace

std::vector<std::string> ScenariosIn(const std::filesystem::path& folder, const std::string& filter) {
  if (!std::filesystem::is_directory(folder)) {
    throw std::invalid_argument(fmt::format("{}: is not a folder", config::PlaceName(folder)));
  }
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && name.find(filter) != std::string::npos) names.push_back(name);
  }
  if (names.empty()) {
    throw std::invalid_argument(fmt::format("{}: holds no scenario with '{}' in its name",
                                            config::PlaceName(folder), config::Printable(filter)));
  }
  std::sort(names.begin(), names.end());
  return names;
}

const char* NameOf(CatalogueOutcome outcome) {
  switch (outcome) {
    case CatalogueOutcome::kPassed:
      return "passed";
    case CatalogueOutcome::kOpen:
      return "open";
    case CatalogueOutcome::kNoLongerOpen:
      return "no longer open";
    case CatalogueOutcome::kFailed:
      break;
  }
  return "failed";
}

std::vector<CatalogueDrive> DriveCatalogue(const std::filesystem::path& folder, const std::string& filter,
                                           int jobs, bool shown) {
  const std::vector<std::string> names = ScenariosIn(folder, filter);
  const std::map<std::string, std::string> open = LoadOpenList(folder);
  ProgressBar bar(names.size());
  bar.Name("catalogue");
  const std::vector<std::string> texts = MapInProcesses(
      names.size(), jobs, [&](std::size_t i) { return DriveOne(folder / names[i] / "scenario.toml", shown); },
      [&] { bar.Advance(); });
  std::vector<CatalogueDrive> drives;
  for (std::size_t i = 0; i < names.size(); ++i) drives.push_back(ReadDrive(names[i], texts[i], open));
  return drives;
}

}  // namespace tools
