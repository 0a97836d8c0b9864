#include "tools/paper/comparison.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

#include "loop/assembly.hpp"

namespace tools {
namespace {

struct Published {
  const char* name;
  int weights;  // N of lpv-N.toml and nmpc-N.toml
  StepTimes nmpc, lpv;
};

// The times in the paper's tables [s].
constexpr std::array<Published, kComparisons> kPublished{{
    {.name = "tracking-1",
     .weights = 1,
     .nmpc = {.average = 0.3067, .maximum = 1.2334, .minimum = 0.0973},
     .lpv = {.average = 0.0145, .maximum = 0.0225, .minimum = 0.0121}},
    {.name = "tracking-2",
     .weights = 2,
     .nmpc = {.average = 0.1982, .maximum = 0.3882, .minimum = 0.1074},
     .lpv = {.average = 0.0155, .maximum = 0.0335, .minimum = 0.0132}},
    {.name = "obstacle-1",
     .weights = 1,
     .nmpc = {.average = 0.6044, .maximum = 1.9183, .minimum = 0.3157},
     .lpv = {.average = 0.0143, .maximum = 0.0221, .minimum = 0.0124}},
    {.name = "obstacle-2",
     .weights = 2,
     .nmpc = {.average = 0.6538, .maximum = 1.6906, .minimum = 0.3422},
     .lpv = {.average = 0.0150, .maximum = 0.0250, .minimum = 0.0131}},
}};

ComparedDrive Drive(const sim::Scenario& scenario, const loop::Config& config, const config::RouteFile& road,
                    const CostWeights& weights, int repeat, ProgressBar& bar) {
  const bus::VehicleBus bus = loop::OpenBus(config);
  ComparedDrive drive{.figures = {}, .times = {}, .record = {}, .config = config};
  std::vector<double> least;
  for (int i = 0; i < repeat; ++i) {
    DriveRecorder recorder(bus, config.mpc.t_s);
    drive.figures =
        MeasureDrive(scenario, config, road, weights, [&](const can::Frame& frame) { recorder.Take(frame); });
    if (!drive.figures.engaged())
      throw std::runtime_error(scenario.name + ": the controller was never engaged");
    drive.record = recorder.record();
    const std::vector<double>& seconds = drive.figures.step_seconds;
    if (least.empty()) least = seconds;
    for (std::size_t k = 0; k < std::min(least.size(), seconds.size()); ++k)
      least[k] = std::min(least[k], seconds[k]);
    bar.Advance();
  }
  const auto [minimum, maximum] = std::ranges::minmax(least);
  drive.times = {
      .average = std::accumulate(least.begin(), least.end(), 0.0) / static_cast<double>(least.size()),
      .maximum = maximum,
      .minimum = minimum};
  return drive;
}

}  // namespace

std::vector<ComparisonRow> CompareWithNmpc(const std::filesystem::path& folder, int repeat,
                                           ProgressBar& bar) {
  std::vector<ComparisonRow> rows;
  for (const Published& published : kPublished) {
    const sim::Scenario scenario = sim::LoadScenario(folder / fmt::format("{}.toml", published.name));
    const auto config_of = [&](const char* kind) {
      return loop::LoadConfig(folder / fmt::format("{}-{}.toml", kind, published.weights));
    };
    const loop::Config lpv = config_of("lpv"), nmpc = config_of("nmpc");
    const config::RouteFile road = config::LoadRoute(lpv.route);
    const CostWeights weights{.Q = nmpc.mpc.Q, .R = nmpc.mpc.R};
    bar.Name(std::string(published.name) + ", NMPC");
    ComparedDrive by_nmpc = Drive(scenario, nmpc, road, weights, repeat, bar);
    bar.Name(std::string(published.name) + ", LPVMPC");
    ComparedDrive by_lpv = Drive(scenario, lpv, road, weights, repeat, bar);
    rows.push_back({.name = published.name,
                    .description = scenario.description,
                    .has_obstacle = !scenario.obstacles.empty(),
                    .road = road,
                    .paper_nmpc = published.nmpc,
                    .paper_lpv = published.lpv,
                    .nmpc = std::move(by_nmpc),
                    .lpv = std::move(by_lpv)});
  }
  return rows;
}

}  // namespace tools
