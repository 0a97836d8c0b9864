#include <algorithm>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "loop/assembly.hpp"
#include "tools/drive/drive_record.hpp"
#include "tools/drive/sweep_config.hpp"
#include "tools/report/report_data.hpp"
#include "tools/sweep/sweep_result.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kDrawn = 12;    // failures with a plot
constexpr std::size_t kListed = 500;  // failures in the table; sweep.json has all

std::string OrDash(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

ordered_json OutcomesSection(const SweepResult& result) {
  const int passable = CountWays(result, PossibleWay::kPass), stop = CountWays(result, PossibleWay::kStop);
  ordered_json columns{"controller"};
  for (const SweepOutcome outcome : kAllOutcomes) columns.push_back(NameOf(outcome));
  columns.push_back(fmt::format("passed of {} passable", passable));
  columns.push_back(fmt::format("failures of {} possible", passable + stop));
  ordered_json rows = ordered_json::array();
  for (const ControllerFigures& line : Tabulate(result)) {
    ordered_json row{line.controller};
    for (const SweepOutcome outcome : kAllOutcomes) row.push_back(std::to_string(line.Count(outcome)));
    row.push_back(std::to_string(line.passed_of_passable));
    row.push_back(std::to_string(line.failures_of_possible));
    rows.push_back(std::move(row));
  }
  return {
      {"type", "table"},
      {"title", "Outcomes"},
      {"paragraphs",
       {fmt::format("Any vehicle at all finds a way past the obstacles in {} of {} scenarios; in {} it can "
                    "only stop before one, in {} neither.",
                    passable, result.scenarios.size(), stop, CountWays(result, PossibleWay::kNone))}},
      {"columns", columns},
      {"rows", rows},
      {"note",
       "Failures: all but passed, stopped and struck, which is touched by no fault of the vehicle's."}};
}

ordered_json FiguresSection(const SweepResult& result) {
  ordered_json rows = ordered_json::array();
  const std::vector<ControllerFigures> table = Tabulate(result);
  for (std::size_t c = 0; c < table.size(); ++c) {
    const ControllerFigures& line = table[c];
    rows.push_back({line.controller, fmt::format("{:.3f}", 1e3 * result.times[c].Percentile(0.5)),
                    fmt::format("{:.3f}", 1e3 * result.times[c].Percentile(0.99)), OrDash(line.cost_ratio, 3),
                    OrDash(line.steering_rate, 3), OrDash(line.jerk, 2)});
  }
  return {
      {"type", "table"},
      {"title", "Figures"},
      {"paragraphs", ordered_json::array()},
      {"columns",
       {"controller", "step, median [ms]", "step, p99 [ms]", "cost to NMPC", "steering rate, RMS [rad/s]",
        "jerk, RMS [m/s³]"}},
      {"rows", rows},
      {"note",
       "Cost, steering rate and jerk are medians over the drives that passed, the cost over those that the "
       "NMPC passed too."}};
}

ordered_json FailuresSection(const SweepResult& result) {
  std::vector<SweepFailure> failures = Failures(result);
  const std::size_t all = failures.size();
  failures.resize(std::min(all, kListed));
  ordered_json rows = ordered_json::array();
  for (const SweepFailure& failure : failures) {
    const SweptScenario& scenario = result.scenarios[failure.scenario];
    const SweepDrive& drive = scenario.drives[failure.controller];
    rows.push_back(
        {fmt::format("seed {}: {}; possible: {}", scenario.seed, scenario.description, NameOf(scenario.way)),
         result.setup.controllers[failure.controller],
         ordered_json{{"text", NameOf(drive.outcome)}, {"verdict", "bad"}}, drive.why});
  }
  return {{"type", "table"},
          {"title", "Failures"},
          {"paragraphs", {"To drive one again: " + result.setup.CommandToDriveAgain()}},
          {"columns", {"scenario", "controller", "outcome", "why"}},
          {"rows", rows},
          {"note", all > kListed ? fmt::format("The first {} of {}.", kListed, all) : ""}};
}

// Drives the scenario again and adds its road, its drive and a section that shows them.
void AddDrawing(const SweepResult& result, const SweepFailure& failure, ordered_json& page) {
  const SweptScenario& scenario = result.scenarios[failure.scenario];
  const std::string& controller = result.setup.controllers[failure.controller];
  const RandomScenario drawn = DrawScenario(scenario.seed, result.setup.ranges);
  const loop::Config config = ConfigFor(controller, result.setup.ranges);
  const bus::VehicleBus bus = loop::OpenBus(config);
  DriveRecorder recorder(bus, config.mpc.t_s);
  const SweepDrive drive =
      DriveSweepScenario(drawn, scenario.way, result.setup.ranges, controller, [&](const can::Frame& frame) {
        recorder.Take(frame);
      }).drive;
  const std::string road = std::to_string(scenario.seed);
  const std::string key = road + " " + controller;
  page["roads"][road] = RoadData(drawn.route);
  page["drives"][key] = DriveData(
      recorder.record(), {.name = controller, .road_key = road, .footprint = drawn.scenario.footprint},
      config, drawn.route);
  page["sections"].push_back(
      {{"type", "drives"},
       {"title", fmt::format("{} by {}: {}", scenario.seed, controller, NameOf(drive.outcome))},
       {"paragraphs", {scenario.description + ".", drive.why + "."}},
       {"drives", {key}}});
}

}  // namespace

ordered_json SweepPage(const SweepResult& result) {
  ordered_json page{{"title", "Sweep"},
                    {"subtitle", result.setup.Describe()},
                    {"roads", ordered_json::object()},
                    {"drives", ordered_json::object()},
                    {"sections", {OutcomesSection(result), FiguresSection(result)}}};
  const std::vector<SweepFailure> worst = WorstFailures(result, kDrawn);
  if (worst.empty()) return page;
  page["sections"].push_back(FailuresSection(result));
  for (const SweepFailure& failure : worst) AddDrawing(result, failure, page);
  return page;
}

}  // namespace tools
