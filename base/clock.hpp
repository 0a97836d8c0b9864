// The clocks of the daemon, and a timer that epoll can wait for.
#pragma once

#include "base/file_descriptor.hpp"
#include "base/time.hpp"

namespace base {

// CLOCK_MONOTONIC: what the daemon goes by.
[[nodiscard]] Time MonotonicNow();
// CLOCK_REALTIME: what the kernel stamps frames by. It may be set at any time.
[[nodiscard]] Time RealNow();

// By CLOCK_MONOTONIC.
class Timer {
 public:
  Timer();

  // Expires once after `first`, then every `every`; never if both are 0.
  void Set(Time first, Time every = {});
  // False if it was set anew since it became readable.
  [[nodiscard]] bool Expired();

  [[nodiscard]] int fd() const { return fd_.get(); }

 private:
  FileDescriptor fd_;
};

}  // namespace base
