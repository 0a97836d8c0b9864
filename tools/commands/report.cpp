#include "tools/commands/report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "can/candump_log.hpp"
#include "config/text_file.hpp"
#include "config/toml_table.hpp"
#include "loop/assembly.hpp"
#include "sim/scenario.hpp"
#include "tools/drive/drive_record.hpp"
#include "tools/io/write_file.hpp"
#include "tools/report/report_data.hpp"
#include "tools/report/report_page.hpp"
#include "tools/scenarios/random_scenario.hpp"
#include "tools/scenarios/scenario_seed.hpp"
#include "tools/sweep/sweep_config.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

ordered_json ParseJson(const std::filesystem::path& file) {
  try {
    return ordered_json::parse(config::ReadTextFile(file));
  } catch (const ordered_json::parse_error& error) {
    throw std::runtime_error(config::PlaceName(file) + ": " + config::Printable(error.what(), 200));
  }
}

struct DriveFile {
  sim::Scenario scenario;
  loop::Config config;
  config::RouteFile road;
};

DriveFile LoadSweepDrive(const config::TomlTable& table) {
  const auto seed =
      static_cast<std::uint64_t>(table.Number("sweep_seed", {0.0, static_cast<double>(kSeedEnd - 1)}));
  const auto interval = [&](const char* key) {
    const std::vector<double> ends = table.Numbers(key, 2);
    return Interval{.low = ends[0], .high = ends[1]};
  };
  const ScenarioRanges ranges{.speed = interval("speed"), .mu = interval("mu")};
  const std::string controller = table.Text("controller");
  table.RefuseUnknownKeys();
  try {
    CheckRanges(ranges);
    const RandomScenario drawn = DrawScenario(seed, ranges);
    return {.scenario = drawn.scenario, .config = ConfigFor(controller, ranges), .road = drawn.route};
  } catch (const std::invalid_argument& error) {
    throw table.Error("sweep_seed", error.what());
  }
}

DriveFile LoadDriveFile(const std::filesystem::path& file) {
  const config::TomlTable table = config::TomlTable::Read(file);
  if (table.Has("sweep_seed")) return LoadSweepDrive(table);
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

DriveRecord ReadLog(const std::filesystem::path& file, const bus::VehicleBus& bus, double t_s) {
  std::ifstream log = config::OpenTextFile(file);
  DriveRecorder recorder(bus, t_s);
  std::string line;
  for (long number = 1; std::getline(log, line); ++number) {
    const auto entry = can::ParseCandumpLine(line);
    if (!entry && log.eof()) break;  // a line that candump had not finished when it was ended
    if (!entry)
      throw std::runtime_error(fmt::format("{}:{}: {}", config::PlaceName(file), number, entry.error()));
    if (*entry) recorder.Take((*entry)->frame);
  }
  if (recorder.record().samples.empty()) {
    throw std::runtime_error(config::PlaceName(file) + ": holds no state of a vehicle");
  }
  return recorder.record();
}

std::string Metres(const ordered_json& value) {
  return value.is_number() ? fmt::format("{:.3f} m", value.get<double>()) : "none";
}

// Of summary.json (sim/summary.hpp).
ordered_json SummarySection(const ordered_json& summary) {
  const auto tile = [](const char* label, const std::string& value, const char* verdict = "") {
    return ordered_json{{"label", label}, {"value", value}, {"verdict", verdict}};
  };
  const auto judged = [](bool good) { return good ? "good" : "bad"; };
  const bool passed = summary.at("passed"), completed = summary.at("completed");
  const int infeasible = summary.at("infeasible_steps");
  const ordered_json& clearance = summary.at("min_clearance_m");
  const ordered_json& time = summary.at("solve_time_us");
  ordered_json items{
      tile("result", passed ? "passed" : "failed", judged(passed)),
      tile("route completed", completed ? "yes" : "no", judged(completed)),
      tile("steps", summary.at("steps").dump()),
      tile("infeasible steps", std::to_string(infeasible), judged(infeasible == 0)),
      tile("smallest clearance", Metres(clearance),
           judged(!clearance.is_number() || clearance.get<double>() >= 0.0)),
      tile("smallest road margin", Metres(summary.at("min_road_margin_m"))),
      tile("RMS lateral error", Metres(summary.at("rms_lateral_error_m"))),
      tile("solve time, median / p99 / max", fmt::format("{} / {} / {} us", time.at("median").dump(),
                                                         time.at("p99").dump(), time.at("max").dump())),
      tile("deadline misses", summary.at("deadline_misses").dump())};
  ordered_json paragraphs = ordered_json::array();
  for (const ordered_json& failed : summary.at("failed_expectations")) {
    paragraphs.push_back("Not as expected: " + failed.get<std::string>());
  }
  return {{"type", "figures"}, {"title", "Result"}, {"paragraphs", paragraphs}, {"items", items}};
}

// The predictions as each obstacle comes into the horizon.
ordered_json FansSection(const DriveRecord& record, int horizon) {
  constexpr std::size_t kFans = 3, kBefore = 4, kSteps = 12;
  ordered_json fans = ordered_json::array();
  for (const control::Obstacle& obstacle : record.obstacles) {
    if (fans.size() == kFans) break;
    const auto distance = [&](const DriveSample& sample) { return record.Distance(sample, obstacle); };
    const auto nearest = static_cast<std::size_t>(std::ranges::min_element(record.samples, {}, distance) -
                                                  record.samples.begin());
    const std::size_t lead = static_cast<std::size_t>(horizon) + kBefore;
    const std::size_t from = nearest > lead ? nearest - lead : 0;
    fans.push_back({{"title", fmt::format("obstacle {}", obstacle.id)},
                    {"drive", "drive"},
                    {"from", from},
                    {"to", std::min(from + kSteps, record.samples.size() - 1)}});
  }
  return {
      {"type", "fans"},
      {"title", "Open-loop predictions at consecutive steps"},
      {"paragraphs", {"What the controller planned, step by step, as an obstacle came into its horizon."}},
      {"fans", fans}};
}

ordered_json DrivePage(const std::filesystem::path& run_dir) {
  const DriveFile drive = LoadDriveFile(run_dir / "drive.toml");
  const bus::VehicleBus bus = loop::OpenBus(drive.config);
  const DriveRecord record = ReadLog(run_dir / "candump.log", bus, drive.config.mpc.t_s);
  const std::string controller = loop::ControllerName(drive.config.controller);

  ordered_json sections = ordered_json::array();
  const std::filesystem::path summary = run_dir / "summary.json";
  if (std::filesystem::exists(summary)) {
    const ordered_json figures = ParseJson(summary);
    try {
      sections.push_back(SummarySection(figures));
    } catch (const ordered_json::exception& error) {
      throw std::runtime_error(config::PlaceName(summary) + ": " + config::Printable(error.what(), 200));
    }
  }
  sections.push_back(
      {{"type", "drives"},
       {"title", "The drive"},
       {"paragraphs", {"Move over a plot: all follow, and the plane shows vehicle and plan of that step."}},
       {"drives", {"drive"}}});
  const bool plans_told =
      std::ranges::any_of(record.samples, [](const DriveSample& s) { return !s.plan.empty(); });
  if (!record.obstacles.empty() && plans_told)
    sections.push_back(FansSection(record, loop::HorizonOf(drive.config)));
  return {
      {"title", drive.scenario.name},
      {"subtitle", fmt::format("{}{}controller {}, N = {}", drive.scenario.description,
                               drive.scenario.description.empty() ? "" : " · ", controller,
                               loop::HorizonOf(drive.config))},
      {"roads", {{"road", RoadData(drive.road)}}},
      {"drives",
       {{"drive",
         DriveData(record, {.name = controller, .road_key = "road", .footprint = drive.scenario.footprint},
                   drive.config, drive.road)}}},
      {"sections", sections}};
}

}  // namespace

void Report(const ReportOptions& options) {
  const std::filesystem::path data = options.run_dir / "report.json";
  const ordered_json page = std::filesystem::exists(data) ? ParseJson(data) : DrivePage(options.run_dir);
  if (!page.is_object() || !page.contains("title") || !page["title"].is_string()) {
    throw std::runtime_error(config::PlaceName(data) + ": holds no data of a page");
  }
  WriteFile(options.output, ReportPage(page["title"].get<std::string>(), page.dump()));
}

void WriteDriveFile(const std::filesystem::path& run_dir, const std::filesystem::path& scenario,
                    const std::filesystem::path& config, const std::string& controller) {
  const auto quoted = [](const std::string& text) { return ordered_json(text).dump(); };  // as in TOML
  const auto path = [&](const std::filesystem::path& file) {
    return quoted(std::filesystem::absolute(file).lexically_normal().string());
  };
  std::string text = "# What this drive was driven with.\n";
  text += "scenario = " + path(scenario) + "\nconfig = " + path(config) +
          "\ncontroller = " + quoted(controller) + "\n";
  WriteFile(run_dir / "drive.toml", text);
}

void WriteSweepDriveFile(const std::filesystem::path& run_dir, std::uint64_t seed,
                         const ScenarioRanges& ranges, const std::string& controller) {
  const auto interval = [](const Interval& range) {
    return ordered_json{range.low, range.high}.dump();  // as in TOML
  };
  WriteFile(
      run_dir / "drive.toml",
      fmt::format("# A scenario of a sweep.\nsweep_seed = {}\nspeed = {}\nmu = {}\ncontroller = \"{}\"\n",
                  seed, interval(ranges.speed), interval(ranges.mu), controller));
}

}  // namespace tools
