// Counts what the program takes from the heap.
#pragma once

#include <cstddef>

namespace test_support {

// Calls of operator new since the program began.
[[nodiscard]] std::size_t Allocations();

}  // namespace test_support
