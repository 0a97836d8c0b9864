// Requests to the kernel that keep cycles on time: priority over other processes, no page faults, selected CPUs. Each
// may be refused; the daemon then runs without it and logs the refusal.
#pragma once

#include <string>
#include <vector>

#include "loop/service_settings.hpp"

namespace lpvmpcd {

struct RealTimeOutcome {
  struct Refusal {
    std::string what;  // the setting and its requested value
    std::string why;
  };
  std::vector<std::string> granted;
  std::vector<Refusal> refused;
};

// Applies the settings to this thread. A single-threaded process calls this once it has built everything it needs.
// Locked memory counts against RLIMIT_MEMLOCK, and so do later allocations, which fail beyond the limit.
[[nodiscard]] RealTimeOutcome ApplyRealTime(const loop::RealTimeSettings& settings);

}  // namespace lpvmpcd
