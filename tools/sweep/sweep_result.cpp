#include "tools/sweep/sweep_result.hpp"

#include <algorithm>
#include <limits>

#include "base/percentile.hpp"
#include "tools/drive/sweep_config.hpp"

namespace tools {
namespace {

std::optional<double> Median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  return base::Percentile(values, 0.5);
}

// The median of `figure` over the drives that passed, as far as they have one; none if none has.
template <typename Figure>
std::optional<double> MedianOfPassed(const SweepResult& result, std::size_t controller,
                                     const Figure& figure) {
  std::vector<double> values;
  for (const SweptScenario& scenario : result.scenarios) {
    if (scenario.drives[controller].outcome != SweepOutcome::kPassed) continue;
    if (const std::optional<double> value = figure(scenario)) values.push_back(*value);
  }
  return Median(std::move(values));
}

std::optional<double> CostRatio(const SweepResult& result, std::size_t controller) {
  const auto& names = result.setup.controllers;
  const auto nmpc = std::ranges::find(names, loop::ControllerName(loop::ControllerKind::kNmpcAffine));
  if (nmpc == names.end()) return std::nullopt;
  const auto standard = static_cast<std::size_t>(nmpc - names.begin());
  return MedianOfPassed(result, controller, [&](const SweptScenario& scenario) -> std::optional<double> {
    const SweepDrive &own = scenario.drives[controller], &other = scenario.drives[standard];
    if (other.outcome != SweepOutcome::kPassed || !own.cost || !other.cost || *other.cost <= 0.0)
      return std::nullopt;
    return *own.cost / *other.cost;
  });
}

}  // namespace

std::vector<ControllerFigures> Tabulate(const SweepResult& result) {
  std::vector<ControllerFigures> table;
  for (std::size_t c = 0; c < result.setup.controllers.size(); ++c) {
    ControllerFigures line{.controller = result.setup.controllers[c]};
    for (const SweptScenario& scenario : result.scenarios) {
      const SweepOutcome outcome = scenario.drives[c].outcome;
      ++line.outcomes[static_cast<std::size_t>(outcome)];
      line.passed_of_passable +=
          static_cast<int>(outcome == SweepOutcome::kPassed && scenario.way == PossibleWay::kPass);
      line.failures_of_possible += static_cast<int>(IsFailure(outcome) && scenario.way != PossibleWay::kNone);
    }
    line.cost_ratio = CostRatio(result, c);
    line.steering_rate = MedianOfPassed(
        result, c, [c](const SweptScenario& scenario) { return scenario.drives[c].rms_steering_rate; });
    line.jerk =
        MedianOfPassed(result, c, [c](const SweptScenario& scenario) { return scenario.drives[c].rms_jerk; });
    table.push_back(std::move(line));
  }
  return table;
}

int CountWays(const SweepResult& result, PossibleWay way) {
  return static_cast<int>(std::ranges::count(result.scenarios, way, &SweptScenario::way));
}

std::vector<SweepFailure> Failures(const SweepResult& result) {
  std::vector<SweepFailure> failures;
  for (std::size_t s = 0; s < result.scenarios.size(); ++s) {
    for (std::size_t c = 0; c < result.setup.controllers.size(); ++c) {
      if (IsFailure(result.scenarios[s].drives[c].outcome))
        failures.push_back({.scenario = s, .controller = c});
    }
  }
  return failures;
}

std::vector<SweepFailure> WorstFailures(const SweepResult& result, std::size_t most) {
  std::vector<SweepFailure> failures = Failures(result);
  const auto rank = [&](const SweepFailure& failure) {
    const SweptScenario& scenario = result.scenarios[failure.scenario];
    const SweepDrive& drive = scenario.drives[failure.controller];
    constexpr double kNone = std::numeric_limits<double>::infinity();
    return std::pair(scenario.way == PossibleWay::kNone, std::min(drive.min_clearance_m.value_or(kNone),
                                                                  drive.min_road_margin_m.value_or(kNone)));
  };
  std::ranges::stable_sort(failures, {}, rank);
  failures.resize(std::min(failures.size(), most));
  return failures;
}

}  // namespace tools
