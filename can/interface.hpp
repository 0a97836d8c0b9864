// What kind of interface it is.
#pragma once

#include <string>

namespace can {

// True if no vehicle can hang on it: its driver is vcan or vxcan. False where that cannot be told.
[[nodiscard]] bool IsVirtual(const std::string& interface);

}  // namespace can
