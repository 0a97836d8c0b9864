#include "tools/report/drive_page.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "can/candump_log.hpp"
#include "config/text_file.hpp"
#include "loop/assembly.hpp"
#include "tools/drive/drive_file.hpp"
#include "tools/drive/drive_record.hpp"
#include "tools/report/report_data.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

DriveRecord ReadLog(const std::filesystem::path& file, const bus::VehicleBus& bus, double t_s) {
  std::ifstream log = config::OpenTextFile(file);
  DriveRecorder recorder(bus, t_s);
  std::string line;
  for (long number = 1; std::getline(log, line); ++number) {
    const auto entry = can::ParseCandumpLine(line);
    if (!entry && log.eof()) break;  // candump was ended within its last line
    if (!entry)
      throw std::runtime_error(fmt::format("{}:{}: {}", config::PlaceName(file), number, entry.error()));
    if (*entry) recorder.Take((*entry)->frame);
  }
  if (recorder.record().samples.empty()) {
    throw std::runtime_error(config::PlaceName(file) + ": contains no state of the vehicle");
  }
  return recorder.record();
}

std::string Metres(const ordered_json& value) {
  return value.is_number() ? fmt::format("{:.3f} m", value.get<double>()) : "none";
}

// The result from summary.json (sim/summary.hpp).
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

// The predictions at the steps in which each of the first three obstacles enters the horizon.
ordered_json FansSection(const DriveRecord& record, int horizon) {
  constexpr std::size_t kFans = 3, kBefore = 4, kSteps = 12;
  ordered_json fans = ordered_json::array();
  for (const RecordedObject& object : record.objects) {
    if (fans.size() == kFans) break;
    const auto distance = [&](const DriveSample& sample) { return Distance(sample, object); };
    const auto nearest = static_cast<std::size_t>(std::ranges::min_element(record.samples, {}, distance) -
                                                  record.samples.begin());
    const std::size_t lead = static_cast<std::size_t>(horizon) + kBefore;
    const std::size_t from = nearest > lead ? nearest - lead : 0;
    fans.push_back({{"title", fmt::format("obstacle {}", object.first.id)},
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

}  // namespace

ordered_json ParseJson(const std::filesystem::path& file) {
  try {
    return ordered_json::parse(config::ReadTextFile(file));
  } catch (const ordered_json::parse_error& error) {
    throw std::runtime_error(config::PlaceName(file) + ": " + config::Printable(error.what(), 200));
  }
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
  const bool has_plans =
      std::ranges::any_of(record.samples, [](const DriveSample& s) { return !s.plan.empty(); });
  if (!record.objects.empty() && has_plans)
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

}  // namespace tools
