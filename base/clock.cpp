#include "base/clock.hpp"

#include <cstdint>
#include <ctime>
#include <sys/timerfd.h>

#include "base/system_call.hpp"

namespace base {
namespace {

Time Read(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
}

}  // namespace

Time MonotonicNow() {
  return Read(CLOCK_MONOTONIC);
}

std::chrono::sys_time<Time> RealNow() {
  return std::chrono::sys_time<Time>(Read(CLOCK_REALTIME));
}

Time ThreadTimeNow() {
  return Read(CLOCK_THREAD_CPUTIME_ID);
}

Timer::Timer()
    : fd_(Checked(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC), "timerfd_create")) {}

void Timer::Set(Time first, Time every) {
  const auto to_timespec = [](Time time) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
    return timespec{.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()};
  };
  const itimerspec spec{.it_interval = to_timespec(every), .it_value = to_timespec(first)};
  static_cast<void>(Checked(::timerfd_settime(fd_.get(), 0, &spec, nullptr), "timerfd_settime"));
}

bool Timer::Expired() {
  std::uint64_t times = 0;
  return ::read(fd_.get(), &times, sizeof(times)) == sizeof(times);
}

}  // namespace base
