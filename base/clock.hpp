// The clocks of the daemon and of measurements, and a timer that epoll can wait for.
#pragma once

#include "base/file_descriptor.hpp"
#include "base/time.hpp"

namespace base {

// CLOCK_MONOTONIC, the daemon's clock.
[[nodiscard]] Time MonotonicNow();
// CLOCK_REALTIME, the clock of the kernel's frame timestamps. It may be set at any time.
[[nodiscard]] std::chrono::sys_time<Time> RealNow();
// CLOCK_THREAD_CPUTIME_ID: the time for which the calling thread has had a processor.
[[nodiscard]] Time ThreadTimeNow();

// A timer on CLOCK_MONOTONIC. A failed system call throws std::runtime_error.
class Timer {
 public:
  Timer();

  // Expires after `first` and then every `every`, or once if `every` is 0. `first` = 0 disarms the timer.
  void Set(Time first, Time every = {});
  // False if the timer was set again since it became readable.
  [[nodiscard]] bool Expired();

  [[nodiscard]] int fd() const { return fd_.get(); }

 private:
  FileDescriptor fd_;
};

}  // namespace base
