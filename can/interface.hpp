// The kind of a network interface.
#pragma once

#include <string>

namespace can {

// True if the driver is vcan or vxcan, so that no vehicle can be attached. False if the driver cannot be determined.
[[nodiscard]] bool IsVirtual(const std::string& interface);

}  // namespace can
