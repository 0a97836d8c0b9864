#include "tools/sweep/sweep_drive.hpp"

#include <cmath>
#include <fmt/format.h>
#include <tuple>

#include "tools/drive/drive_figures.hpp"
#include "tools/drive/sweep_config.hpp"

namespace tools {
namespace {

SweepOutcome OutcomeOf(const sim::Summary& summary) {
  const auto& [contact, off_road] = std::tie(summary.contact_step, summary.off_road_step);
  if (contact && (!off_road || *contact <= *off_road)) return SweepOutcome::kContact;
  if (off_road) return SweepOutcome::kOffRoad;
  if (summary.completed) return SweepOutcome::kPassed;
  return summary.standing ? SweepOutcome::kStopped : SweepOutcome::kFailed;
}

std::string WhyOf(SweepOutcome outcome, const DriveFigures& figures) {
  std::string why;
  if (outcome == SweepOutcome::kContact)
    why = fmt::format("contact at step {}", *figures.summary.contact_step);
  if (outcome == SweepOutcome::kOffRoad)
    why = fmt::format("off the road at step {}", *figures.summary.off_road_step);
  if (outcome == SweepOutcome::kFailed) why = figures.summary.steps > 0 ? "end not reached" : "never engaged";
  if (figures.first_failure) why += (why.empty() ? "" : "; ") + ToText(*figures.first_failure);
  return why;
}

std::optional<double> Finite(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

const char* NameOf(SweepOutcome outcome) {
  switch (outcome) {
    case SweepOutcome::kPassed:
      return "passed";
    case SweepOutcome::kStopped:
      return "stopped";
    case SweepOutcome::kContact:
      return "contact";
    case SweepOutcome::kOffRoad:
      return "off-road";
    case SweepOutcome::kFailed:
      break;
  }
  return "failed";
}

TimedSweepDrive DriveSweepScenario(const RandomScenario& drawn, const ScenarioRanges& ranges,
                                   const std::string& controller,
                                   const std::function<void(const can::Frame&)>& frame) {
  const control::MpcSettings weights;
  const loop::Config config = ConfigFor(controller, ranges);
  const DriveFigures figures = MeasureDrive(drawn.scenario, config, RouteFor(drawn, config),
                                            {.Q = weights.Q, .R = weights.R, .along = false}, frame);
  const sim::Summary& summary = figures.summary;
  const SweepOutcome outcome = OutcomeOf(summary);
  return {.drive = {.outcome = outcome,
                    .why = WhyOf(outcome, figures),
                    .steps = summary.steps,
                    .infeasible_steps = summary.infeasible_steps,
                    .min_clearance_m = Finite(summary.min_clearance_m),
                    .min_road_margin_m = Finite(summary.min_road_margin_m),
                    .cost = Finite(figures.cost),
                    .rms_steering_rate = Finite(figures.rms_steering_rate),
                    .rms_jerk = Finite(figures.rms_jerk)},
          .step_seconds = figures.step_seconds};
}

}  // namespace tools
