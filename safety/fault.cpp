#include "safety/fault.hpp"

#include <array>
#include <cstddef>

#include "bus/message_fields.hpp"
#include "bus/names.hpp"

namespace safety {
namespace {

using bus::FaultCode;

// Rows in the order of the enumerators.
constexpr auto kCauses = std::to_array<CauseRow>({
    {Cause::kStart, "start", FaultCode::kNone, Severity::kEvent},
    {Cause::kInputsHealthy, "inputs healthy", FaultCode::kNone, Severity::kEvent},
    {Cause::kEngaged, "engaged", FaultCode::kNone, Severity::kEvent},
    {Cause::kReleased, "request withdrawn", FaultCode::kNone, Severity::kEvent},
    {Cause::kOverride, "driver override", FaultCode::kNone, Severity::kEvent},
    {Cause::kStandstill, "standstill", FaultCode::kNone, Severity::kEvent},
    {Cause::kRecovered, "recovered", FaultCode::kNone, Severity::kEvent},
    {Cause::kBusDown, "", FaultCode::kBusDown, Severity::kHard},
    {Cause::kStateStale, "", FaultCode::kStateStale, Severity::kHard},
    {Cause::kStateInvalid, "", FaultCode::kStateInvalid, Severity::kHard},
    {Cause::kObstaclesStale, "", FaultCode::kObstaclesStale, Severity::kSoft},
    {Cause::kDriverRequestStale, "", FaultCode::kDriverRequestStale, Severity::kSoft},
    {Cause::kRouteEnd, "", FaultCode::kRouteEnd, Severity::kHard},
    {Cause::kPlanExhausted, "", FaultCode::kPlanExhausted, Severity::kHard},
    {Cause::kSilent, "no command sent for too long", FaultCode::kInternalError, Severity::kHard},
    {Cause::kInternalError, "", FaultCode::kInternalError, Severity::kHard},
    {Cause::kStateLate, "", FaultCode::kStateLate, Severity::kSoft},
    {Cause::kSolverFailed, "problem not solved", FaultCode::kSolverNumericalFailure, Severity::kSoft},
    {Cause::kDeadlineMissed, "", FaultCode::kDeadlineMissed, Severity::kSoft},
    {Cause::kPlanRejected, "", FaultCode::kPlanRejected, Severity::kSoft},
    {Cause::kStopDue, "last clear stop", FaultCode::kPlanRejected, Severity::kHard},
});
static_assert(kCauses.size() == static_cast<std::size_t>(LastOf(Cause{})) + 1);

}  // namespace

const CauseRow& RowOf(Cause cause) {
  return kCauses[static_cast<std::size_t>(cause)];
}

std::string_view Name(Cause cause) {
  const CauseRow& row = RowOf(cause);
  return row.text.empty() ? bus::Name(row.code) : row.text;
}

bus::FaultCode FaultOf(Cause cause) {
  return RowOf(cause).code;
}

bool IsHard(Cause cause) {
  return RowOf(cause).severity == Severity::kHard;
}

}  // namespace safety
