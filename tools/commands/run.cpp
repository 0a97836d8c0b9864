#include "tools/commands/run.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "bus/names.hpp"
#include "can/candump_log.hpp"
#include "config/qp_file.hpp"
#include "config/text_file.hpp"
#include "loop/assembly.hpp"
#include "tools/drive/closed_loop.hpp"
#include "tools/drive/drive_file.hpp"
#include "tools/drive/drive_record.hpp"
#include "tools/drive/scenario_config.hpp"
#include "tools/drive/sweep_config.hpp"
#include "tools/io/write_file.hpp"
#include "tools/report/report.hpp"
#include "tools/scenarios/random_scenario.hpp"
#include "tools/scenarios/traffic_scenario.hpp"

namespace tools {
namespace {

struct Task {
  sim::Scenario scenario;
  loop::Config config;
  config::RouteFile route;
};

Task LoadTask(const RunOptions& options) {
  if (options.drawn()) {
    CheckRanges(options.ranges);
    const RandomScenario drawn = options.sweep_seed
                                     ? DrawScenario(*options.sweep_seed, options.ranges)
                                     : DrawTraffic(PointOf(options.traffic_key), options.ranges);
    const std::string controller = options.controller.empty() ? "lpv-affine" : options.controller;
    const loop::Config config = ConfigFor(controller, options.ranges);
    return {.scenario = drawn.scenario, .config = config, .route = RouteFor(drawn, config)};
  }
  const sim::Scenario scenario = sim::LoadScenario(options.scenario);
  loop::Config config = LoadConfigFor(scenario, options.scenario, options.config);
  if (!options.controller.empty()) loop::SelectController(config, options.controller);
  const config::RouteFile route = config::LoadRoute(config.route);
  return {.scenario = scenario, .config = std::move(config), .route = route};
}

void WriteDriveFileOf(const RunOptions& options, const Task& task) {
  const std::string controller = loop::ControllerName(task.config.controller);
  if (options.sweep_seed) {
    WriteSweepDriveFile(options.out, *options.sweep_seed, options.ranges, controller);
  } else if (options.drawn()) {
    WriteTrafficDriveFile(options.out, options.traffic_key, options.ranges, controller);
  } else {
    WriteDriveFile(options.out, options.scenario,
                   options.config.empty() ? task.scenario.daemon_config : options.config, controller);
  }
}

// Writes each problem to its own file, numbered in order. Throws std::invalid_argument if `folder` already holds
// problems.
control::QpObserver Recorder(const std::filesystem::path& folder) {
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() != ".qp") continue;
      throw std::invalid_argument(
          fmt::format("--record-qp: {} holds problems of another run", config::PlaceName(folder)));
    }
  }
  return [folder, count = 0](const control::VehicleQp& qp) mutable {
    if (count == 0) MakeFolder(folder);
    std::ostringstream text;
    config::WriteQpFile(qp, text);
    WriteFile(folder / fmt::format("qp_{:06}.qp", count++), text.str());
  };
}

std::string DecisionsText(const DriveRecord& record) {
  std::string text;
  for (const RecordedDecision& decision : record.decisions) {
    text +=
        fmt::format("{:7.2f} s  {}\n", record.Time(decision.cycle), bus::ManoeuvreText(decision.manoeuvre));
  }
  return text;
}

}  // namespace

int Run(const RunOptions& options, std::ostream& out) {
  const Task task = LoadTask(options);
  const loop::Config& config = task.config;

  const bool out_folder = !options.out.empty();
  const std::filesystem::path log_file = out_folder ? options.out / "candump.log" : options.log;
  std::ofstream log;
  const bus::VehicleBus bus = loop::OpenBus(config);
  DriveRecorder recorder(bus, config.mpc.t_s);
  ClosedLoopHooks hooks;
  hooks.frame = [&](const can::Frame& frame) { recorder.Take(frame); };
  if (!log_file.empty()) {
    hooks.frame = [&](const can::Frame& frame) {
      recorder.Take(frame);
      // The log is opened only after all input was validated: a mistyped option does not overwrite an existing log.
      if (!log.is_open()) {
        if (out_folder) MakeFolder(options.out);
        log.open(log_file);
      }
      if (!log) throw std::runtime_error(log_file.string() + ": cannot be written: " + std::strerror(errno));
      log << can::FormatCandumpLine(frame, config.service.interface) << '\n';
    };
  }
  if (!options.record_qp.empty()) hooks.qp = Recorder(options.record_qp);
  const auto start = std::chrono::steady_clock::now();
  const sim::Summary summary = DriveClosedLoop(task.scenario, config, task.route, hooks);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  if (log.is_open() && !log.flush()) {
    throw std::runtime_error(log_file.string() + ": cannot be written: " + std::strerror(errno));
  }
  if (out_folder) {
    std::filesystem::remove(options.out / "report.json");  // an old report.json would be shown instead
    WriteFile(options.out / "summary.json", sim::ToJson(summary));
    WriteDriveFileOf(options, task);
    Report({.run_dir = options.out, .output = options.out / "report.html"});
  }

  if (options.json) {
    out << sim::ToJson(summary);
  } else {
    const double driven = static_cast<double>(summary.steps) * config.mpc.t_s;
    out << DecisionsText(recorder.record()) << sim::ToText(summary)
        << fmt::format("{:.1f} s driven in {:.3f} s, {:.0f} times real time\n", driven, elapsed.count(),
                       driven / elapsed.count());
  }
  return summary.passed() ? 0 : 1;
}

}  // namespace tools
