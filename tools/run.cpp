#include "tools/run.hpp"

#include <chrono>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

#include "can/candump_log.hpp"
#include "tools/closed_loop.hpp"

namespace tools {

int Run(const RunOptions& options, std::ostream& out) {
  const sim::Scenario scenario = sim::LoadScenario(options.scenario);
  const std::filesystem::path config_file = options.config.empty() ? scenario.daemon_config : options.config;
  if (config_file.empty()) {
    throw std::runtime_error(options.scenario.string() + ": names no daemon_config; give one by --config");
  }
  lpvmpcd::Config config = lpvmpcd::LoadConfig(config_file);
  if (!options.controller.empty()) lpvmpcd::SelectController(config, options.controller);

  std::ofstream log;
  ClosedLoopHooks hooks;
  if (!options.log.empty()) {
    log.open(options.log);
    if (!log) throw std::runtime_error("cannot write " + options.log.string());
    hooks.frame = [&](const can::Frame& frame) {
      log << can::FormatCandumpLine(frame, config.service.interface) << '\n';
    };
  }
  const auto start = std::chrono::steady_clock::now();
  const sim::Summary summary = DriveClosedLoop(scenario, config, hooks);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  if (log.is_open() && !log.flush()) throw std::runtime_error("cannot write " + options.log.string());

  if (options.json) {
    out << sim::ToJson(summary) << '\n';
  } else {
    const double driven = static_cast<double>(summary.steps) * config.mpc.t_s;
    out << sim::ToText(summary)
        << fmt::format("{:.1f} s driven in {:.3f} s, {:.0f} times real time\n", driven, elapsed.count(),
                       driven / elapsed.count());
  }
  return summary.passed() ? 0 : 1;
}

}  // namespace tools
