#include "tools/sweep/sweep_drive.hpp"

#include <cmath>

#include "tools/drive/drive_figures.hpp"
#include "tools/drive/sweep_config.hpp"

namespace tools {
namespace {

std::string WhyOf(SweepOutcome outcome, const DriveFigures& figures) {
  std::string why = ReasonOf(outcome, figures.summary);
  if (figures.first_failure) why += (why.empty() ? "" : "; ") + ToText(*figures.first_failure);
  return why;
}

std::optional<double> Finite(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

TimedSweepDrive DriveSweepScenario(const RandomScenario& drawn, PossibleWay way, const ScenarioRanges& ranges,
                                   const std::string& controller,
                                   const std::function<void(const can::Frame&)>& frame) {
  const control::MpcSettings weights;
  const loop::Config config = ConfigFor(controller, ranges);
  const DriveFigures figures = MeasureDrive(drawn.scenario, config, RouteFor(drawn, config),
                                            {.Q = weights.Q, .R = weights.R, .along = false}, frame);
  const sim::Summary& summary = figures.summary;
  const SweepOutcome outcome = OutcomeOf(summary, drawn.scenario.expect, way);
  return {.drive = {.outcome = outcome,
                    .why = WhyOf(outcome, figures),
                    .steps = summary.steps,
                    .infeasible_steps = summary.infeasible_steps,
                    .safe_stops = summary.safe_stops,
                    .min_clearance_m = Finite(summary.min_clearance_m),
                    .min_road_margin_m = Finite(summary.min_road_margin_m),
                    .longest_free_standstill_s = summary.longest_free_standstill_s,
                    .max_speed_excess_mps = Finite(summary.max_speed_excess_mps),
                    .end_overshoot_m = Finite(summary.end_overshoot_m),
                    .cost = Finite(figures.cost),
                    .rms_steering_rate = Finite(figures.rms_steering_rate),
                    .rms_jerk = Finite(figures.rms_jerk)},
          .step_seconds = figures.step_seconds};
}

}  // namespace tools
