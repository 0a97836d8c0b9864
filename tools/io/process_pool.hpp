// Distributes work over processes: each item runs in its own child process, so that a crash, or a library that only one
// thread of a process may use (MUMPS), does not affect the others.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tools {

// Calls work(0) .. work(count - 1), `jobs` at a time, and returns their results in that order, whatever the order of
// completion. `done` is called in this process after each. The caller must have no other threads. Throws
// std::runtime_error with the message of the first item that fails, or if no pipe or process can be created; items
// still running are killed.
[[nodiscard]] std::vector<std::string> MapInProcesses(std::size_t count, int jobs,
                                                      const std::function<std::string(std::size_t)>& work,
                                                      const std::function<void()>& done = nullptr);

}  // namespace tools
