#include "tools/sweep/sweep_json.hpp"

#include <array>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>

#include <nlohmann/json.hpp>

#include "tools/io/json_values.hpp"
#include "tools/scenarios/scenario_seed.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

ordered_json DriveJson(const SweepDrive& drive) {
  return {{"outcome", NameOf(drive.outcome)},
          {"why", drive.why},
          {"steps", drive.steps},
          {"infeasible_steps", drive.infeasible_steps},
          {"safe_stops", drive.safe_stops},
          {"min_clearance_m", OrNull(drive.min_clearance_m)},
          {"min_road_margin_m", OrNull(drive.min_road_margin_m)},
          {"longest_free_standstill_s", drive.longest_free_standstill_s},
          {"max_speed_excess_m_s", OrNull(drive.max_speed_excess_mps)},
          {"end_overshoot_m", OrNull(drive.end_overshoot_m)},
          {"cost", OrNull(drive.cost)},
          {"rms_steering_rate_rad_s", OrNull(drive.rms_steering_rate)},
          {"rms_jerk_m_s3", OrNull(drive.rms_jerk)}};
}

SweepDrive DriveOf(const ordered_json& json) {
  return {.outcome = Named(kAllOutcomes, json.at("outcome").get<std::string>()),
          .why = json.at("why"),
          .steps = json.at("steps"),
          .infeasible_steps = json.at("infeasible_steps"),
          .safe_stops = json.at("safe_stops"),
          .min_clearance_m = NumberOrNone(json.at("min_clearance_m")),
          .min_road_margin_m = NumberOrNone(json.at("min_road_margin_m")),
          .longest_free_standstill_s = json.at("longest_free_standstill_s"),
          .max_speed_excess_mps = NumberOrNone(json.at("max_speed_excess_m_s")),
          .end_overshoot_m = NumberOrNone(json.at("end_overshoot_m")),
          .cost = NumberOrNone(json.at("cost")),
          .rms_steering_rate = NumberOrNone(json.at("rms_steering_rate_rad_s")),
          .rms_jerk = NumberOrNone(json.at("rms_jerk_m_s3"))};
}

ordered_json HistogramJson(const TimeHistogram& times) {
  ordered_json json = ordered_json::object();
  for (const auto& [bucket, count] : times.counts()) json[std::to_string(bucket)] = count;
  return json;
}

void TakeHistogram(const ordered_json& json, TimeHistogram& times) {
  for (const auto& [bucket, count] : json.items())
    times.AddBucket(std::stoi(bucket), count.get<std::int64_t>());
}

ordered_json SetupJson(const SweepSetup& setup) {
  const ScenarioRanges& ranges = setup.ranges;
  return {{"seed", setup.seed},
          {"count", setup.count},
          {"speed_m_s", {ranges.speed.low, ranges.speed.high}},
          {"mu", {ranges.mu.low, ranges.mu.high}},
          {"traffic", ranges.traffic},
          {"controllers", setup.controllers}};
}

SweepSetup SetupOf(const ordered_json& json) {
  const auto interval = [&](const char* key) {
    return Interval{.low = json.at(key).at(0), .high = json.at(key).at(1)};
  };
  SweepSetup setup{
      .seed = json.at("seed"),
      .count = json.at("count"),
      .ranges = {.speed = interval("speed_m_s"), .mu = interval("mu"), .traffic = json.at("traffic")},
      .controllers = json.at("controllers")};
  CheckSetup(setup);
  return setup;
}

ordered_json ScenarioJson(const SweptScenario& scenario, const SweepSetup& setup) {
  ordered_json drives = ordered_json::object();
  for (std::size_t c = 0; c < setup.controllers.size(); ++c)
    drives[setup.controllers[c]] = DriveJson(scenario.drives[c]);
  return {{"index", scenario.index},
          {"seed", scenario.seed},
          {"description", scenario.description},
          {"possible", NameOf(scenario.way)},
          {"drives", drives}};
}

SweptScenario ScenarioOf(const ordered_json& json, const SweepSetup& setup) {
  using enum PossibleWay;
  SweptScenario scenario{
      .index = json.at("index"),
      .seed = json.at("seed"),
      .description = json.at("description"),
      .way = Named(std::array{kPass, kStop, kNone}, json.at("possible").get<std::string>()),
      .drives = {}};
  for (const std::string& controller : setup.controllers)
    scenario.drives.push_back(DriveOf(json.at("drives").at(controller)));
  return scenario;
}

ordered_json ScenariosJson(const SweepResult& result) {
  ordered_json scenarios = ordered_json::array();
  for (const SweptScenario& scenario : result.scenarios)
    scenarios.push_back(ScenarioJson(scenario, result.setup));
  return scenarios;
}

ordered_json TableJson(const SweepResult& result) {
  const int passable = CountWays(result, PossibleWay::kPass), stop = CountWays(result, PossibleWay::kStop);
  ordered_json table = ordered_json::array();
  for (const ControllerFigures& line : Tabulate(result)) {
    ordered_json row{{"controller", line.controller},
                     {"scenarios", result.scenarios.size()},
                     {"passable", passable},
                     {"stop_possible", stop}};
    for (const SweepOutcome outcome : kAllOutcomes) row[NameOf(outcome)] = line.Count(outcome);
    row["passed_of_passable"] = line.passed_of_passable;
    row["failures_of_possible"] = line.failures_of_possible;
    row["median_cost_ratio_to_nmpc"] = OrNull(line.cost_ratio);
    row["median_rms_steering_rate_rad_s"] = OrNull(line.steering_rate);
    row["median_rms_jerk_m_s3"] = OrNull(line.jerk);
    table.push_back(std::move(row));
  }
  return table;
}

}  // namespace

ordered_json ToJson(const SweepResult& result) {
  return {
      {"sweep", SetupJson(result.setup)}, {"table", TableJson(result)}, {"scenarios", ScenariosJson(result)}};
}

ordered_json TimingJson(const SweepResult& result) {
  ordered_json timing = ordered_json::object();
  for (std::size_t c = 0; c < result.setup.controllers.size(); ++c) {
    std::int64_t steps = 0;
    for (const auto& [bucket, count] : result.times[c].counts()) steps += count;
    timing[result.setup.controllers[c]] = {{"steps", steps},
                                           {"median_s", result.times[c].Percentile(0.5)},
                                           {"p99_s", result.times[c].Percentile(0.99)}};
  }
  return timing;
}

ordered_json PartJson(const SweepPart& part) {
  ordered_json times = ordered_json::object();
  for (std::size_t c = 0; c < part.result.times.size(); ++c)
    times[part.result.setup.controllers[c]] = HistogramJson(part.result.times[c]);
  return {{"sweep", SetupJson(part.result.setup)},
          {"shard", {{"index", part.shard.index}, {"of", part.shard.of}}},
          {"scenarios", ScenariosJson(part.result)},
          {"times", times}};
}

SweepPart PartOf(const ordered_json& json) {
  SweepPart part;
  SweepResult& result = part.result;
  result.setup = SetupOf(json.at("sweep"));
  part.shard = {.index = json.at("shard").at("index"), .of = json.at("shard").at("of")};
  if (part.shard.index < 1 || part.shard.index > part.shard.of)
    throw std::invalid_argument(fmt::format("shard {}/{} does not exist", part.shard.index, part.shard.of));
  for (const ordered_json& scenario : json.at("scenarios"))
    result.scenarios.push_back(ScenarioOf(scenario, result.setup));
  const std::vector<int> indices = part.shard.Indices(result.setup.count);
  bool whole = indices.size() == result.scenarios.size();
  for (std::size_t i = 0; whole && i < indices.size(); ++i) {
    const SweptScenario& scenario = result.scenarios[i];
    whole = scenario.index == indices[i] &&
            scenario.seed == ScenarioSeed(result.setup.seed, static_cast<std::uint64_t>(scenario.index));
  }
  if (!whole) throw std::invalid_argument("its scenarios are not those of its shard");
  for (const std::string& controller : result.setup.controllers)
    TakeHistogram(json.at("times").at(controller), result.times.emplace_back());
  return part;
}

ordered_json TimedDriveJson(const SweepDrive& drive, const TimeHistogram& times) {
  return {{"drive", DriveJson(drive)}, {"times", HistogramJson(times)}};
}

void TakeTimedDrive(const ordered_json& json, SweepDrive& drive, TimeHistogram& times) {
  drive = DriveOf(json.at("drive"));
  TakeHistogram(json.at("times"), times);
}

}  // namespace tools
