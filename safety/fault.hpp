// Why a mode is entered or a plan missing: one table, a row a cause, with its text, its fault code on the bus and how grave
// it is. What logs, bus and mode machine say and do about a cause follows from its row.
#pragma once

#include <cstdint>
#include <string_view>

#include "bus/messages.hpp"

namespace safety {

using Cause = bus::ModeCause;

enum class Severity : std::uint8_t {
  kEvent,  // no fault
  kSoft,   // the vehicle drives on without for a while (Degraded)
  kHard,   // the vehicle is stopped at once (SafeStop), or nothing is commanded any more (Fault)
};

struct CauseRow {
  Cause cause{};
  std::string_view text;
  bus::FaultCode code{};  // kNone for an event
  Severity severity{};
};

[[nodiscard]] const CauseRow& RowOf(Cause cause);

[[nodiscard]] inline std::string_view Name(Cause cause) {
  return RowOf(cause).text;
}
[[nodiscard]] inline bus::FaultCode FaultOf(Cause cause) {
  return RowOf(cause).code;
}
[[nodiscard]] inline bool IsHard(Cause cause) {
  return RowOf(cause).severity == Severity::kHard;
}

}  // namespace safety
