#include "tools/bench/bench_catalogue.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/time.hpp"
#include "config/route_file.hpp"
#include "control/vehicle/geometry.hpp"
#include "loop/config.hpp"
#include "sim/scenario.hpp"
#include "tools/bench/roadside_posts.hpp"
#include "tools/bench/times.hpp"
#include "tools/catalogue/drive_catalogue.hpp"
#include "tools/drive/closed_loop.hpp"
#include "tools/drive/scenario_config.hpp"
#include "tools/io/progress_bar.hpp"

namespace tools {
namespace {

struct Aim {
  const char* name;
  double (Times::*figure)() const;
  double most;  // [µs]
};
constexpr Aim kAims[] = {{.name = "median", .figure = &Times::Median, .most = 120.0},
                         {.name = "p99", .figure = &Times::P99, .most = 500.0},
                         {.name = "worst", .figure = &Times::Max, .most = 1000.0}};

struct Line {
  std::string name;
  Times processor;            // least of each cycle
  double longest_wall = 0.0;  // [µs]
  double slowest_at = 0.0;    // time of the slowest cycle since the start [s]
  bool passed = false;
};

struct Cycle {
  double at = 0.0;         // since the start [s]
  double processor = 0.0;  // [µs]
};

double Microseconds(base::Time time) {
  return 1e6 * base::ToSeconds(time);
}

Line Measure(const std::filesystem::path& file, const BenchCatalogueOptions& options) {
  const sim::Scenario scenario = sim::LoadScenario(file);
  loop::Config config = LoadConfigFor(scenario, file, {});
  config.mpc.horizon = config.affine.horizon = options.horizon;
  const config::RouteFile route = config::LoadRoute(config.route);
  Line line;
  std::vector<Cycle> cycles;
  for (int i = 0; i < options.repeat; ++i) {
    RoadsidePosts posts(scenario, route);
    std::size_t k = 0;
    double now = 0.0;
    const ClosedLoopHooks hooks{
        .sense =
            [&](sim::VirtualVehicle& vehicle) {
              now = vehicle.time();
              const auto wanted = static_cast<std::size_t>(options.objects);
              const std::size_t own = std::min(vehicle.PerceivedNow().size(), wanted);
              vehicle.SetGhosts(posts.Ahead(control::Position(vehicle.state()), wanted - own));
            },
        .cycle =
            [&](const CycleTimes& times, const loop::CycleReport& report) {
              if (!bus::Commands(report.mode)) return;
              const double processor = Microseconds(times.processor);
              if (k == cycles.size()) cycles.push_back({.at = now, .processor = processor});
              cycles[k].processor = std::min(cycles[k].processor, processor);
              line.longest_wall = std::max(line.longest_wall, Microseconds(times.wall));
              ++k;
            }};
    line.passed = DriveClosedLoop(scenario, config, route, hooks).passed();
  }
  double slowest = 0.0;
  for (const Cycle& cycle : cycles) {
    line.processor.Add(cycle.processor);
    if (cycle.processor <= slowest) continue;
    slowest = cycle.processor;
    line.slowest_at = cycle.at;
  }
  return line;
}

std::string Missed(const Line& line) {
  std::string missed;
  for (const Aim& aim : kAims) {
    const double figure = (line.processor.*aim.figure)();
    if (figure <= aim.most) continue;
    missed += fmt::format("{}{} {:.0f} > {:.0f} us", missed.empty() ? "" : ", ", aim.name, figure, aim.most);
  }
  return missed;
}

nlohmann::ordered_json ToJson(const Line& line) {
  nlohmann::ordered_json row = {{"name", line.name}, {"cycles", line.processor.count()}};
  row.update(line.processor.ToJson());
  row["max_wall_us"] = line.longest_wall;
  row["slowest_at_s"] = line.slowest_at;
  row["passed"] = line.passed;
  row["missed"] = Missed(line);
  return row;
}

std::string ToText(const Line& line) {
  const Times& times = line.processor;
  return fmt::format("{:28}{:8}{:11.1f}{:9.1f}{:9.1f}{:13.1f}{:14.2f}  {}\n", line.name, times.count(),
                     times.Median(), times.P99(), times.Max(), line.longest_wall, line.slowest_at,
                     line.passed ? "passed" : "failed");
}

}  // namespace

void BenchCatalogue(const BenchCatalogueOptions& options, std::ostream& out) {
  const std::vector<std::string> names = ScenariosIn(options.folder, options.filter);
  std::vector<Line> lines;
  Line all;
  all.name = "all";
  all.passed = true;
  ProgressBar bar(names.size());
  for (const std::string& name : names) {
    bar.Name(name);
    Line line = Measure(options.folder / name / "scenario.toml", options);
    line.name = name;
    if (line.processor.Max() > all.processor.Max()) all.slowest_at = line.slowest_at;
    all.processor.Add(line.processor);
    all.longest_wall = std::max(all.longest_wall, line.longest_wall);
    all.passed = all.passed && line.passed;
    lines.push_back(std::move(line));
    bar.Advance();
  }
  if (options.json) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const Line& line : lines) rows.push_back(ToJson(line));
    out << nlohmann::ordered_json{{"horizon", options.horizon},
                                  {"objects", options.objects},
                                  {"scenarios", rows},
                                  {"all", ToJson(all)}}
               .dump(2)
        << '\n';
    return;
  }
  out << fmt::format("{:28}{:>8}{:>11}{:>9}{:>9}{:>13}{:>14}  {}\n", "scenario", "cycles", "median_us",
                     "p99_us", "max_us", "max_wall_us", "slowest_at_s", "outcome");
  for (const Line& line : lines) out << ToText(line);
  out << ToText(all) << '\n';
  int missed = 0;
  for (const Line& line : lines) {
    const std::string text = Missed(line);
    if (text.empty()) continue;
    ++missed;
    out << line.name << ": " << text << '\n';
  }
  out << fmt::format("{} of {} scenarios miss an aim\n", missed, lines.size());
}

}  // namespace tools
