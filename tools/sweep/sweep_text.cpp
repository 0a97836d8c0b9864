#include <fmt/format.h>

#include "tools/sweep/sweep_result.hpp"

namespace tools {
namespace {

std::string OrDash(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

void AppendOutcomes(const SweepResult& result, std::string& text) {
  text += fmt::format("\n  {:16}", "controller");
  for (const SweepOutcome outcome : kAllOutcomes) text += fmt::format("{:>10}", NameOf(outcome));
  text += fmt::format("{:>12}{:>13}\n", "passed of", "failures of");
  text += fmt::format("  {:16}{:{}}{:>12}{:>13}\n", "", "", 10 * kAllOutcomes.size(), "passable", "possible");
  for (const ControllerFigures& line : Tabulate(result)) {
    text += fmt::format("  {:16}", line.controller);
    for (const SweepOutcome outcome : kAllOutcomes) text += fmt::format("{:>10}", line.Count(outcome));
    text += fmt::format("{:>12}{:>13}\n", line.passed_of_passable, line.failures_of_possible);
  }
}

void AppendFigures(const SweepResult& result, std::string& text) {
  text += fmt::format("\n  {:16}{:>18}{:>15}{:>15}{:>23}{:>18}\n", "controller", "step median [ms]",
                      "step p99 [ms]", "cost to nmpc", "steering RMS [rad/s]", "jerk RMS [m/s3]");
  const std::vector<ControllerFigures> table = Tabulate(result);
  for (std::size_t c = 0; c < table.size(); ++c) {
    const ControllerFigures& line = table[c];
    text += fmt::format("  {:16}{:>18.3f}{:>15.3f}{:>15}{:>23}{:>18}\n", line.controller,
                        1e3 * result.times[c].Percentile(0.5), 1e3 * result.times[c].Percentile(0.99),
                        OrDash(line.cost_ratio, 3), OrDash(line.steering_rate, 3), OrDash(line.jerk, 2));
  }
}

void AppendFailures(const SweepResult& result, std::string& text) {
  const std::vector<SweepFailure> failures = Failures(result);
  if (failures.empty()) return;
  text += fmt::format("\nFailures; to drive one again:\n  {}\n\n", result.setup.CommandToDriveAgain());
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
  AppendOutcomes(result, text);
  AppendFigures(result, text);
  AppendFailures(result, text);
  return text;
}

}  // namespace tools
