#include "tools/sweep/drive_sweep.hpp"

#include <nlohmann/json.hpp>

#include "tools/io/process_pool.hpp"
#include "tools/io/progress_bar.hpp"
#include "tools/scenarios/random_scenario.hpp"
#include "tools/scenarios/scenario_seed.hpp"
#include "tools/scenarios/space_time_way.hpp"

namespace tools {

namespace {

// The scenarios of the shard, not yet driven.
std::vector<SweptScenario> DrawScenarios(const SweepSetup& setup, const Shard& shard, int jobs) {
  std::vector<SweptScenario> scenarios;
  for (const int index : shard.Indices(setup.count)) {
    const std::uint64_t seed = ScenarioSeed(setup.seed, static_cast<std::uint64_t>(index));
    scenarios.push_back({.index = index,
                         .seed = seed,
                         .description = DrawScenario(seed, setup.ranges).scenario.description,
                         .drives = {}});
  }
  const auto judge = [&](std::size_t i) {
    const sim::Scenario scenario = DrawScenario(scenarios[i].seed, setup.ranges).scenario;
    const PossibleWay way = setup.ranges.traffic ? FindSpaceTimeWay(scenario) : FindPossibleWay(scenario);
    return std::to_string(static_cast<int>(way));
  };
  ProgressBar bar(scenarios.size());
  bar.Name("scenarios");
  const std::vector<std::string> texts =
      MapInProcesses(scenarios.size(), jobs, judge, [&] { bar.Advance(); });
  for (std::size_t i = 0; i < scenarios.size(); ++i)
    scenarios[i].way = static_cast<PossibleWay>(std::stoi(texts[i]));
  return scenarios;
}

}  // namespace

SweepPart DriveSweep(const SweepSetup& setup, const Shard& shard, int jobs) {
  SweepPart part{.result = {.setup = setup, .scenarios = DrawScenarios(setup, shard, jobs), .times = {}},
                 .shard = shard};
  std::vector<SweptScenario>& scenarios = part.result.scenarios;
  const std::size_t controllers = setup.controllers.size();
  const std::size_t drives = scenarios.size() * controllers;
  ProgressBar bar(drives);
  bar.Name("sweep");
  const auto drive = [&](std::size_t i) {
    const SweptScenario& scenario = scenarios[i / controllers];
    const TimedSweepDrive driven = DriveSweepScenario(DrawScenario(scenario.seed, setup.ranges), scenario.way,
                                                      setup.ranges, setup.controllers[i % controllers]);
    TimeHistogram times;
    for (const double seconds : driven.step_seconds) times.Add(seconds);
    return TimedDriveJson(driven.drive, times).dump();
  };
  const std::vector<std::string> texts = MapInProcesses(drives, jobs, drive, [&] { bar.Advance(); });

  part.result.times.resize(controllers);
  for (std::size_t i = 0; i < drives; ++i) {
    SweepDrive& driven = scenarios[i / controllers].drives.emplace_back();
    TakeTimedDrive(nlohmann::ordered_json::parse(texts[i]), driven, part.result.times[i % controllers]);
  }
  return part;
}

}  // namespace tools
