// How a drive of a sweep ended.
#pragma once

#include <array>
#include <string>

#include "sim/scenario.hpp"
#include "sim/summary.hpp"
#include "tools/scenarios/possible_way.hpp"

namespace tools {

// The first that holds, in the order of OutcomeOf(), is the drive's outcome.
enum class SweepOutcome {
  kPassed,  // none of the others, and the vehicle reached the end of the route
  kStopped,  // none of the others, and the vehicle stood before the end, or was under way where one can only stop
  kStruck,   // touched by something, by no fault of the vehicle's
  kContact,  // touched something by its own fault (sim/encounter_figures.hpp) and had not left the road before
  kOffRoad,   // a corner left the road before any such contact
  kDeadlock,  // stood for more than 5 s though the way was free
  kSafeStop,  // gave up driving, in a scenario in which a way exists
  kTooFast,   // exceeded the target speed by more than the scenario expects
  kOverrun,   // went further past the route's end than the scenario expects
  kFailed,    // never engaged, taken over, or not at the end after twice the route's time plus 10 s
};

inline constexpr std::array kAllOutcomes{
    SweepOutcome::kPassed,  SweepOutcome::kStopped,  SweepOutcome::kStruck,   SweepOutcome::kContact,
    SweepOutcome::kOffRoad, SweepOutcome::kDeadlock, SweepOutcome::kSafeStop, SweepOutcome::kTooFast,
    SweepOutcome::kOverrun, SweepOutcome::kFailed};

// "passed", "stopped", "struck", "contact", "off-road", "deadlock", "safe-stop", "too-fast", "overrun", "failed"
[[nodiscard]] const char* NameOf(SweepOutcome outcome);

[[nodiscard]] constexpr bool IsFailure(SweepOutcome outcome) {
  return outcome != SweepOutcome::kPassed && outcome != SweepOutcome::kStopped &&
         outcome != SweepOutcome::kStruck;
}

// `way`: what was possible in the scenario.
[[nodiscard]] SweepOutcome OutcomeOf(const sim::Summary& summary, const sim::Expectations& expect,
                                     PossibleWay way);
// What of the summary made the outcome a failure; empty if it is none.
[[nodiscard]] std::string ReasonOf(SweepOutcome outcome, const sim::Summary& summary);

}  // namespace tools
