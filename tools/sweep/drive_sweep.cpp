#include "tools/sweep/drive_sweep.hpp"

#include <nlohmann/json.hpp>

#include "tools/io/process_pool.hpp"
#include "tools/io/progress_bar.hpp"
#include "tools/scenarios/random_scenario.hpp"
#include "tools/scenarios/scenario_seed.hpp"

namespace tools {

SweepPart DriveSweep(const SweepSetup& setup, const Shard& shard, int jobs) {
  SweepPart part{.result = {.setup = setup, .scenarios = {}, .times = {}}, .shard = shard};
  std::vector<SweptScenario>& scenarios = part.result.scenarios;
  for (const int index : shard.Indices(setup.count)) {
    const std::uint64_t seed = ScenarioSeed(setup.seed, static_cast<std::uint64_t>(index));
    const sim::Scenario scenario = DrawScenario(seed, setup.ranges).scenario;
    scenarios.push_back({.index = index,
                         .seed = seed,
                         .description = scenario.description,
                         .way = FindPossibleWay(scenario),
                         .drives = {}});
  }

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
