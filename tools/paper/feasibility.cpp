#include "tools/paper/feasibility.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "config/toml_table.hpp"
#include "loop/assembly.hpp"
#include "tools/drive/scenario_config.hpp"

namespace tools {
namespace {

FeasibilityDrive Drive(const sim::Scenario& scenario, loop::Config config, const config::RouteFile& road,
                       const char* controller) {
  loop::SelectController(config, controller);
  const bus::VehicleBus bus = loop::OpenBus(config);
  DriveRecorder recorder(bus, config.mpc.t_s);
  const DriveFigures figures = MeasureDrive(scenario, config, road, {.Q = config.mpc.Q, .R = config.mpc.R},
                                            [&](const can::Frame& frame) { recorder.Take(frame); });
  if (!figures.engaged()) throw std::runtime_error(scenario.name + ": the controller was never engaged");
  const DriveRecord& record = recorder.record();
  const std::size_t end =
      figures.first_failure ? SampleOfStep(record, figures.first_failure->step) : record.samples.size();
  const DriveRecord before = end > 0 ? Excerpt(record, 0, end - 1) : DriveRecord{};
  return {.figures = figures,
          .record = record,
          .config = config,
          .largest_plan_change = LargestPlanChange(before)};
}

// The sideways shift of the route that clears a circle beside it [m].
double Shift(const control::Route& route, const control::Obstacle& obstacle) {
  const double lateral = route.Project({obstacle.X, obstacle.Y}).lateral;
  return obstacle.r_x + (obstacle.side == control::PassingSide::kLeft ? lateral : -lateral);
}

}  // namespace

std::vector<FeasibilityRow> CompareFeasibility(const std::filesystem::path& folder, ProgressBar& bar) {
  std::vector<FeasibilityRow> rows;
  for (int i = 1; i <= kFeasibilityScenarios; ++i) {
    const std::string number = fmt::format("{:02}", i);
    const std::filesystem::path file = folder / (number + ".toml");
    const sim::Scenario scenario = sim::LoadScenario(file);
    const loop::Config config = LoadConfigFor(scenario, file, {});
    const config::RouteFile road = config::LoadRoute(config.route);
    if (scenario.obstacles.size() != 1) throw config::ConfigError(file.string() + ": must hold one obstacle");
    bar.Name("feasibility " + number);
    FeasibilityDrive standard = Drive(scenario, config, road, "lpv-standard");
    bar.Advance();
    FeasibilityDrive trust_region = Drive(scenario, config, road, "lpv");
    bar.Advance();
    rows.push_back({.number = number,
                    .description = scenario.description,
                    .speed = road.route.At(0.0).speed,
                    .shift = Shift(road.route, scenario.obstacles.front()),
                    .road = road,
                    .standard = std::move(standard),
                    .trust_region = std::move(trust_region)});
  }
  return rows;
}

}  // namespace tools
