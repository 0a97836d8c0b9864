#include "safety/fault.hpp"

#include <array>
#include <cstddef>

#include "bus/message_fields.hpp"

namespace safety {
namespace {

using bus::FaultCode;

// In the order of the enumerators.
constexpr auto kCauses = std::to_array<CauseRow>({
    {Cause::kStart, "start", FaultCode::kNone, Severity::kEvent},
    {Cause::kInputsHealthy, "inputs healthy", FaultCode::kNone, Severity::kEvent},
    {Cause::kEngaged, "engaged", FaultCode::kNone, Severity::kEvent},
    {Cause::kReleased, "request withdrawn", FaultCode::kNone, Severity::kEvent},
    {Cause::kOverride, "driver override", FaultCode::kNone, Severity::kEvent},
    {Cause::kStandstill, "standstill", FaultCode::kNone, Severity::kEvent},
    {Cause::kRecovered, "recovered", FaultCode::kNone, Severity::kEvent},
    {Cause::kBusDown, "bus down", FaultCode::kBusDown, Severity::kHard},
    {Cause::kStateStale, "vehicle state stale", FaultCode::kStateStale, Severity::kHard},
    {Cause::kStateInvalid, "vehicle state refused", FaultCode::kStateInvalid, Severity::kHard},
    {Cause::kObstaclesStale, "obstacles stale", FaultCode::kObstaclesStale, Severity::kSoft},
    {Cause::kDriverRequestStale, "driver request stale", FaultCode::kDriverRequestStale, Severity::kSoft},
    {Cause::kRouteEnd, "end of route", FaultCode::kRouteEnd, Severity::kHard},
    {Cause::kPlanExhausted, "plan exhausted", FaultCode::kPlanExhausted, Severity::kHard},
    {Cause::kSilent, "no command sent for too long", FaultCode::kInternalError, Severity::kHard},
    {Cause::kInternalError, "internal error", FaultCode::kInternalError, Severity::kHard},
    {Cause::kStateLate, "no new vehicle state", FaultCode::kStateLate, Severity::kSoft},
    {Cause::kSolverFailed, "problem not solved", FaultCode::kSolverNumericalFailure, Severity::kSoft},
    {Cause::kDeadlineMissed, "deadline missed", FaultCode::kDeadlineMissed, Severity::kSoft},
    {Cause::kPlanRejected, "plan rejected", FaultCode::kPlanRejected, Severity::kSoft},
});
static_assert(kCauses.size() == static_cast<std::size_t>(LastOf(Cause{})) + 1);

}  // namespace

const CauseRow& RowOf(Cause cause) {
  return kCauses[static_cast<std::size_t>(cause)];
}

}  // namespace safety
