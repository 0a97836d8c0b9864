#include <fmt/format.h>

#include "tools/sweep/sweep_result.hpp"

namespace tools {
namespace {

std::string OrDash(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

void AppendTable(const SweepResult& result, std::string& text) {
  text += fmt::format("\n  {:14}{:>8}{:>9}{:>9}{:>10}{:>8}{:>12}{:>12}{:>12}{:>12}{:>9}{:>13}{:>9}\n",
                      "controller", "passed", "stopped", "contact", "off-road", "failed", "of passable",
                      "failures of", "step", "step p99", "cost", "steering", "jerk");
  text += fmt::format("  {:14}{:>8}{:>9}{:>9}{:>10}{:>8}{:>12}{:>12}{:>12}{:>12}{:>9}{:>13}{:>9}\n", "", "",
                      "", "", "", "", "passed", "possible", "median [ms]", "[ms]", "to nmpc", "RMS [rad/s]",
                      "[m/s3]");
  const std::vector<ControllerFigures> table = Tabulate(result);
  for (std::size_t c = 0; c < table.size(); ++c) {
    const ControllerFigures& line = table[c];
    text +=
        fmt::format("  {:14}{:>8}{:>9}{:>9}{:>10}{:>8}{:>12}{:>12}{:>12.3f}{:>12.3f}{:>9}{:>13}{:>9}\n",
                    line.controller, line.outcomes[0], line.outcomes[1], line.outcomes[2], line.outcomes[3],
                    line.outcomes[4], line.passed_of_passable, line.failures_of_possible,
                    1e3 * result.times[c].Percentile(0.5), 1e3 * result.times[c].Percentile(0.99),
                    OrDash(line.cost_ratio, 3), OrDash(line.steering_rate, 3), OrDash(line.jerk, 2));
  }
}

void AppendFailures(const SweepResult& result, std::string& text) {
  const std::vector<SweepFailure> failures = Failures(result);
  if (failures.empty()) return;
  const ScenarioRanges& ranges = result.setup.ranges;
  text += fmt::format(
      "\nContact, off the road or failed; to drive one again:\n"
      "  lpvmpc run --sweep-seed SEED --speed {} {} --mu {} {} --controller NAME\n\n",
      ranges.speed.low, ranges.speed.high, ranges.mu.low, ranges.mu.high);
  const SweptScenario* last = nullptr;
  for (const SweepFailure& failure : failures) {
    const SweptScenario& scenario = result.scenarios[failure.scenario];
    const SweepDrive& drive = scenario.drives[failure.controller];
    if (&scenario != last) {
      text +=
          fmt::format("  {}  {}; possible: {}\n", scenario.seed, scenario.description, NameOf(scenario.way));
    }
    last = &scenario;
    text += fmt::format("      {:14}{}\n", result.setup.controllers[failure.controller], drive.why);
  }
}

}  // namespace

std::string ToText(const SweepResult& result) {
  std::string text =
      fmt::format("{}\nthe obstacles can be passed in {} of them, only stopped before in {}, neither in {}\n",
                  result.setup.Describe(), CountWays(result, PossibleWay::kPass),
                  CountWays(result, PossibleWay::kStop), CountWays(result, PossibleWay::kNone));
  AppendTable(result, text);
  AppendFailures(result, text);
  return text;
}

}  // namespace tools
