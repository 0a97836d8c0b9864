#include "tools/sweep/sweep_outcome.hpp"

#include <fmt/format.h>
#include <optional>

namespace tools {
namespace {

constexpr double kDeadlock = 5.0;  // longest standstill though the way is free [s]

bool Exceeds(const std::optional<double>& value, const std::optional<double>& limit) {
  return value && limit && *value > *limit;
}

}  // namespace

const char* NameOf(SweepOutcome outcome) {
  switch (outcome) {
    case SweepOutcome::kPassed:
      return "passed";
    case SweepOutcome::kStopped:
      return "stopped";
    case SweepOutcome::kStruck:
      return "struck";
    case SweepOutcome::kContact:
      return "contact";
    case SweepOutcome::kOffRoad:
      return "off-road";
    case SweepOutcome::kDeadlock:
      return "deadlock";
    case SweepOutcome::kSafeStop:
      return "safe-stop";
    case SweepOutcome::kTooFast:
      return "too-fast";
    case SweepOutcome::kOverrun:
      return "overrun";
    case SweepOutcome::kFailed:
      break;
  }
  return "failed";
}

SweepOutcome OutcomeOf(const sim::Summary& summary, const sim::Expectations& expect, PossibleWay way) {
  const auto &contact = summary.contact_step, &off_road = summary.off_road_step;
  const bool own_contact = contact && summary.contact_fault == sim::ContactFault::kOurs;
  if (own_contact && (!off_road || *contact <= *off_road)) return SweepOutcome::kContact;
  if (off_road) return SweepOutcome::kOffRoad;
  if (contact) return SweepOutcome::kStruck;
  if (summary.safe_stops > 0 && way != PossibleWay::kNone) return SweepOutcome::kSafeStop;
  if (summary.longest_free_standstill_s > kDeadlock) return SweepOutcome::kDeadlock;
  // Where one can only stop, the vehicle may be behind something slow when the time is up.
  const bool under_way = way == PossibleWay::kStop && summary.steps > 0;
  if (!summary.completed && !summary.standing && !under_way) return SweepOutcome::kFailed;
  if (Exceeds(summary.max_speed_excess_mps, expect.max_speed_excess_mps)) return SweepOutcome::kTooFast;
  if (Exceeds(summary.end_overshoot_m, expect.max_end_overshoot_m)) return SweepOutcome::kOverrun;
  return summary.completed ? SweepOutcome::kPassed : SweepOutcome::kStopped;
}

std::string ReasonOf(SweepOutcome outcome, const sim::Summary& summary) {
  switch (outcome) {
    case SweepOutcome::kContact:
      return fmt::format("contact at step {}", *summary.contact_step);
    case SweepOutcome::kOffRoad:
      return fmt::format("off the road at step {}", *summary.off_road_step);
    case SweepOutcome::kDeadlock:
      return fmt::format("stood for {:.1f} s though the way was free", summary.longest_free_standstill_s);
    case SweepOutcome::kSafeStop:
      return fmt::format("{} safe stop{}", summary.safe_stops, summary.safe_stops == 1 ? "" : "s");
    case SweepOutcome::kTooFast:
      return fmt::format("{:.1f} m/s above the target speed", summary.max_speed_excess_mps.value_or(0.0));
    case SweepOutcome::kOverrun:
      return fmt::format("{:.2f} m past the end", summary.end_overshoot_m.value_or(0.0));
    case SweepOutcome::kFailed:
      return summary.steps > 0 ? "end not reached" : "never engaged";
    case SweepOutcome::kPassed:
    case SweepOutcome::kStopped:
    case SweepOutcome::kStruck:
      break;
  }
  return "";
}

}  // namespace tools
