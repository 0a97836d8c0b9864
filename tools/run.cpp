#include "tools/run.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

#include "can/candump_log.hpp"
#include "tools/closed_loop.hpp"
#include "tools/report.hpp"
#include "tools/scenario_config.hpp"
#include "tools/write_file.hpp"

namespace tools {

int Run(const RunOptions& options, std::ostream& out) {
  const sim::Scenario scenario = sim::LoadScenario(options.scenario);
  lpvmpcd::Config config = LoadConfigFor(scenario, options.scenario, options.config);
  if (!options.controller.empty()) lpvmpcd::SelectController(config, options.controller);

  const bool out_folder = !options.out.empty();
  const std::filesystem::path log_file = out_folder ? options.out / "candump.log" : options.log;
  std::ofstream log;
  ClosedLoopHooks hooks;
  if (!log_file.empty()) {
    hooks.frame = [&](const can::Frame& frame) {
      // Not before all input proved good: a log that stands there is not lost to a slip of the pen.
      if (!log.is_open()) {
        if (out_folder) MakeFolder(options.out);
        log.open(log_file);
      }
      if (!log) throw std::runtime_error(log_file.string() + ": cannot be written: " + std::strerror(errno));
      log << can::FormatCandumpLine(frame, config.service.interface) << '\n';
    };
  }
  const auto start = std::chrono::steady_clock::now();
  const sim::Summary summary = DriveClosedLoop(scenario, config, hooks);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  if (log.is_open() && !log.flush()) {
    throw std::runtime_error(log_file.string() + ": cannot be written: " + std::strerror(errno));
  }
  if (out_folder) {
    std::filesystem::remove(options.out / "report.json");  // of another run, which the report would show
    WriteFile(options.out / "summary.json", sim::ToJson(summary));
    WriteDriveFile(options.out, options.scenario,
                   options.config.empty() ? scenario.daemon_config : options.config,
                   lpvmpcd::ControllerName(config.controller));
    Report({.run_dir = options.out, .output = options.out / "report.html"});
  }

  if (options.json) {
    out << sim::ToJson(summary);
  } else {
    const double driven = static_cast<double>(summary.steps) * config.mpc.t_s;
    out << sim::ToText(summary)
        << fmt::format("{:.1f} s driven in {:.3f} s, {:.0f} times real time\n", driven, elapsed.count(),
                       driven / elapsed.count());
  }
  return summary.passed() ? 0 : 1;
}

}  // namespace tools
