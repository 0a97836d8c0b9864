// Causes of a mode change or of a missing plan: one table with a row per cause, giving its text, its fault code on the
// bus and its severity. Logs, bus and mode machine all use this row.
#pragma once

#include <cstdint>
#include <string_view>

#include "bus/messages.hpp"

namespace safety {

using Cause = bus::ModeCause;

enum class Severity : std::uint8_t {
  kEvent,  // no fault
  kSoft,   // tolerated for a while: the vehicle drives on (Degraded)
  kHard,   // the vehicle is stopped at once (SafeStop), or commands are disabled (Fault)
};

struct CauseRow {
  Cause cause{};
  std::string_view text;  // empty: that of the code
  bus::FaultCode code{};  // kNone for an event
  Severity severity{};
};

[[nodiscard]] const CauseRow& RowOf(Cause cause);

[[nodiscard]] std::string_view Name(Cause cause);
[[nodiscard]] bus::FaultCode FaultOf(Cause cause);
[[nodiscard]] bool IsHard(Cause cause);

}  // namespace safety
