#include "tools/commands/command.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <thread>

#include "loop/config.hpp"
#include "tools/scenarios/scenario_seed.hpp"

namespace tools {

void RequireOption(const CLI::App& command, const char* option) {
  if (command.count(option) == 0) throw CLI::RequiredError(option);
}

void AddRanges(CLI::App& command, ScenarioRanges& ranges) {
  const auto add = [&command](const char* option, Interval& range, const std::string& what) {
    command
        .add_option_function<std::vector<double>>(
            option, [&range](const std::vector<double>& ends) { range = {.low = ends[0], .high = ends[1]}; },
            what)
        ->type_name("LO HI")
        ->expected(2)
        ->default_str(fmt::format("{} {}", range.low, range.high));
  };
  add("--speed", ranges.speed, "target speeds of a sweep [m/s]");
  add("--mu", ranges.mu, "friction coefficients of a sweep");
}

void AddTraffic(CLI::App& command, ScenarioRanges& ranges) {
  command.add_flag("--traffic", ranges.traffic,
                   "scenarios with traffic, instead of one to three obstacles on a road of constant width");
}

void AddJobs(CLI::App& command, int& jobs) {
  command.add_option("--jobs", jobs, "number of processes that drive")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

CLI::Range Seeds() {
  return {std::uint64_t{0}, kSeedEnd - 1};
}

std::filesystem::path Scenarios(const char* part) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  return program.parent_path().parent_path() / "share/lpvmpcd/scenarios" / part;
}

std::string ControllerList() {
  return fmt::format("{}", fmt::join(loop::ControllerNames(), ", "));
}

int Processors() {
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace tools
