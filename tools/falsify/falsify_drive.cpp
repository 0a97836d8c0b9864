#include "tools/falsify/falsify_drive.hpp"

#include <algorithm>

#include "tools/drive/closed_loop.hpp"
#include "tools/drive/sweep_config.hpp"
#include "tools/scenarios/space_time_way.hpp"
#include "tools/scenarios/traffic_scenario.hpp"

namespace tools {
namespace {

sim::Summary Drive(const RandomScenario& drawn, const FalsifySetup& setup) {
  const loop::Config config = ConfigFor(setup.controller, setup.ranges);
  return DriveClosedLoop(drawn.scenario, config, RouteFor(drawn, config));
}

}  // namespace

std::optional<double> MarginOf(const sim::Summary& summary) {
  const bool theirs = summary.contact_fault == sim::ContactFault::kTheirs;
  std::optional<double> margin = summary.min_road_margin_m;
  if (summary.min_clearance_m && !theirs)
    margin = std::min(margin.value_or(*summary.min_clearance_m), *summary.min_clearance_m);
  return margin;
}

std::optional<double> DriveMargin(const TrafficPoint& point, const FalsifySetup& setup) {
  const RandomScenario drawn = DrawTraffic(point, setup.ranges);
  const std::optional<double> margin = MarginOf(Drive(drawn, setup));
  if (margin && *margin < 0.0 && FindSpaceTimeWay(drawn.scenario) == PossibleWay::kNone) return std::nullopt;
  return margin;
}

Finding FindingOf(const TrafficPoint& point, double margin, const FalsifySetup& setup) {
  const RandomScenario drawn = DrawTraffic(point, setup.ranges);
  const sim::Summary summary = Drive(drawn, setup);
  const PossibleWay way = FindSpaceTimeWay(drawn.scenario);
  const SweepOutcome outcome = OutcomeOf(summary, drawn.scenario.expect, way);
  return {.key = KeyOf(point),
          .margin = margin,
          .outcome = outcome,
          .why = ReasonOf(outcome, summary),
          .way = way,
          .description = drawn.scenario.description};
}

}  // namespace tools
