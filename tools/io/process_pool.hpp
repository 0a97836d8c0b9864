// Work shared among processes: each item runs in a child of its own, so that what it breaks or what only one thread of a
// process may use (MUMPS) is its own matter.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tools {

// Calls work(0) .. work(count - 1), `jobs` at the same time, and gives their results in that order, whatever the order in
// which they came. `done` is called in this process after each. The caller must have no threads. Throws
// std::runtime_error with the message of the item that failed first; those still running are ended.
[[nodiscard]] std::vector<std::string> MapInProcesses(std::size_t count, int jobs,
                                                      const std::function<std::string(std::size_t)>& work,
                                                      const std::function<void()>& done = nullptr);

}  // namespace tools
