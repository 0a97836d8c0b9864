// Readable names of the bus's enumerators, for logs and reports.
#pragma once

#include <string_view>

#include "bus/messages.hpp"

namespace bus {

[[nodiscard]] std::string_view Name(Mode mode);
[[nodiscard]] std::string_view Name(FaultCode fault);
[[nodiscard]] std::string_view Name(ConstraintVerdict verdict);
[[nodiscard]] std::string_view Name(ConstraintName constraint);

}  // namespace bus
