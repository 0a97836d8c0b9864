// Signals that are read from a file descriptor instead of interrupting the program.
#pragma once

#include <initializer_list>

#include "base/file_descriptor.hpp"

namespace base {

// Blocks these signals for the calling thread and those that it starts later, and returns a non-blocking signalfd(2) that
// reads them. Throws std::runtime_error if the kernel refuses.
[[nodiscard]] FileDescriptor BlockSignals(std::initializer_list<int> signals);

}  // namespace base
