// Readable names of the bus's enumerators, for logs and reports.
#pragma once

#include <string>
#include <string_view>

#include "bus/messages.hpp"

namespace bus {

[[nodiscard]] std::string_view Name(Mode mode);
[[nodiscard]] std::string_view Name(FaultCode fault);
[[nodiscard]] std::string_view Name(ConstraintVerdict verdict);
[[nodiscard]] std::string_view Name(ConstraintName constraint);
[[nodiscard]] std::string_view Name(ManoeuvreReason reason);

// What the vehicle does: "passes object 3 on the left", "waits", "no decision".
[[nodiscard]] std::string DecisionText(const ManoeuvreStatus& manoeuvre);
// The same with the reason: "passes object 3 on the left: the way is free".
[[nodiscard]] std::string ManoeuvreText(const ManoeuvreStatus& manoeuvre);

}  // namespace bus
