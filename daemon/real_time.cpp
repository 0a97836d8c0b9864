#include "daemon/real_time.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

namespace lpvmpcd {
namespace {

constexpr std::size_t kStack = 256UL * 1024;
constexpr std::size_t kPage = 4096;

std::string ErrnoText() {
  return std::strerror(errno);
}

// Each CPU is requested alone first: given a set, the kernel silently ignores the CPUs that do not exist.
void UseCpus(const std::vector<int>& cpus, RealTimeOutcome& outcome) {
  cpu_set_t granted;
  CPU_ZERO(&granted);
  std::vector<int> names;
  for (const int cpu : cpus) {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(cpu), &one);
    if (::sched_setaffinity(0, sizeof(one), &one) == 0) {
      CPU_SET(static_cast<std::size_t>(cpu), &granted);
      names.push_back(cpu);
    } else {
      const std::string why = errno == EINVAL ? "there is none, or it is not for this process" : ErrnoText();
      outcome.refused.push_back({fmt::format("cpu {}", cpu), why});
    }
  }
  if (names.empty()) {
    return;
  }
  if (::sched_setaffinity(0, sizeof(granted), &granted) == 0) {
    outcome.granted.push_back(fmt::format("cpus {}", fmt::join(names, ", ")));
  } else {
    outcome.refused.push_back({fmt::format("cpus {}", fmt::join(names, ", ")), ErrnoText()});
  }
}

// Touches the part of the stack that the control path will use, so that it is mapped and locked by then.
[[gnu::noinline]] void TouchStack() {
  std::array<volatile char, kStack> stack;
  for (std::size_t i = 0; i < stack.size(); i += kPage) {
    stack[i] = 0;
  }
}

void LockMemory(RealTimeOutcome& outcome) {
  // Freed memory is neither trimmed nor unmapped, so that memory used once does not fault again.
  ::mallopt(M_TRIM_THRESHOLD, -1);
  ::mallopt(M_MMAP_MAX, 0);
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    outcome.refused.push_back({"lock_memory", ErrnoText()});
    return;
  }
  outcome.granted.emplace_back("memory locked");
  rlimit limit{};
  if (::getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < 2 * kStack) {
    outcome.refused.push_back({fmt::format("stack of {} KiB", kStack / 1024),
                               fmt::format("its limit is {} KiB", limit.rlim_cur / 1024)});
    return;
  }
  TouchStack();
}

void UseFifo(int priority, RealTimeOutcome& outcome) {
  const sched_param parameter{.sched_priority = priority};
  // Child processes get the usual scheduling.
  if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameter) == 0) {
    outcome.granted.push_back(fmt::format("SCHED_FIFO {}", priority));
  } else {
    outcome.refused.push_back({fmt::format("fifo_priority {}", priority), ErrnoText()});
  }
}

}  // namespace

RealTimeOutcome ApplyRealTime(const loop::RealTimeSettings& settings) {
  RealTimeOutcome outcome;
  UseCpus(settings.cpus, outcome);
  if (settings.lock_memory) {
    LockMemory(outcome);
  }
  if (settings.fifo_priority > 0) {
    UseFifo(settings.fifo_priority, outcome);
  }
  return outcome;
}

}  // namespace lpvmpcd
