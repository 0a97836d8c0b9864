#include "base/signals.hpp"

#include <csignal>
#include <sys/signalfd.h>

#include "base/system_call.hpp"

namespace base {

FileDescriptor BlockSignals(std::initializer_list<int> signals) {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int signal : signals) ::sigaddset(&set, signal);
  static_cast<void>(Checked(::sigprocmask(SIG_BLOCK, &set, nullptr), "sigprocmask"));
  return FileDescriptor(Checked(::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC), "signalfd"));
}

}  // namespace base
