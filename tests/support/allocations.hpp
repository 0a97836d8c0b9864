// Counts the program's heap allocations.
#pragma once

#include <cstddef>

namespace test_support {

// Calls of operator new since the program began.
[[nodiscard]] std::size_t Allocations();

}  // namespace test_support
