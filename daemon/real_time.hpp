// What a process asks of the kernel so that its cycles are on time: priority over other processes, no page faults, CPUs
// of its own. Each may be refused; the daemon then runs without it and says so.
#pragma once

#include <string>
#include <vector>

#include "loop/service_settings.hpp"

namespace lpvmpcd {

struct RealTimeOutcome {
  struct Refusal {
    std::string what;  // with the value that was asked for
    std::string why;
  };
  std::vector<std::string> granted;
  std::vector<Refusal> refused;
};

// Asks for what the settings say, for this thread: to be called by a process of one thread, once it has built all that
// it needs. Locked memory counts against RLIMIT_MEMLOCK, as does what is allocated later, which then fails.
[[nodiscard]] RealTimeOutcome ApplyRealTime(const loop::RealTimeSettings& settings);

}  // namespace lpvmpcd
