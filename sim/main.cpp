// lpvmpc-sim: the simulated vehicle of a scenario on a CAN interface.
#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/signals.hpp"
#include "bus/vehicle_bus.hpp"
#include "can/socket.hpp"
#include "sim/bus_run.hpp"
#include "sim/options.hpp"
#include "sim/scenario.hpp"
#include "sim/summary.hpp"

namespace {

constexpr int kPassed = 0;
constexpr int kFailed = 1;
constexpr int kBadInput = 2;

// `stop_signals`: a descriptor that reads the signals that end the drive.
int Drive(const sim::Options& options, int stop_signals) {
  std::optional<sim::Scenario> scenario;
  const bus::VehicleBus bus;
  std::optional<can::Socket> socket;
  try {
    scenario = sim::LoadScenario(options.scenario);
    socket.emplace(options.interface, can::SocketOptions{.filters = sim::ControllerFilters(bus)});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lpvmpc-sim: %s\n", error.what());
    return kBadInput;
  }
  const auto timeout = std::chrono::duration<double>(options.timeout);
  sim::BusRun run(*scenario, bus, *socket, stop_signals,
                  {.lockstep = options.lockstep,
                   .controller_timeout = std::chrono::duration_cast<std::chrono::milliseconds>(timeout)});
  const sim::Summary summary = run.Run();
  // JSON on stdout is for a machine; a person watching still gets the summary.
  std::fputs(sim::ToText(summary).c_str(), options.json ? stderr : stdout);
  if (options.json) std::fputs(sim::ToJson(summary).c_str(), stdout);
  if (std::fflush(stdout) != 0) throw std::runtime_error("standard output: cannot be written");
  return summary.passed() ? kPassed : kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    // First of all: no thread may start before.
    const base::FileDescriptor stop_signals = base::BlockSignals({SIGINT, SIGTERM});
    int exit_code = kPassed;
    const std::optional<sim::Options> options = sim::ParseOptions(argc, argv, exit_code);
    return options ? Drive(*options, stop_signals.get()) : exit_code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lpvmpc-sim: %s\n", error.what());
    return kFailed;
  }
}
