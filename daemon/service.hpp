// The shell about the control loop: waits for frames, the timer and signals, and has the only clocks of the
// daemon.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "base/clock.hpp"
#include "base/file_descriptor.hpp"
#include "base/latency_histogram.hpp"
#include "base/time.hpp"
#include "can/socket.hpp"
#include "daemon/event_log.hpp"
#include "daemon/notifier.hpp"
#include "daemon/real_time.hpp"
#include "daemon/transmitter.hpp"
#include "loop/control_loop.hpp"
#include "loop/service_settings.hpp"

namespace lpvmpcd {

inline constexpr base::Time kLockstepTimeout = std::chrono::seconds(2);

class Service {
 public:
  // Opens the interface and blocks the signals that Run reacts to. Throws std::runtime_error: no such interface, one
  // that is not virtual for lock step, or a system call failed. `loop` must outlive the service.
  Service(const loop::ServiceSettings& settings, loop::ControlLoop& loop, std::function<void()> reload);

  // Until SIGTERM or SIGINT; then a last pair of commands, not enabled, is sent. An interface that goes down or away
  // is waited for. SIGUSR1 logs how quick the daemon has been, SIGHUP calls `reload`.
  void Run();

 private:
  [[nodiscard]] base::Time Now() const;
  void BecomeRealTime();
  [[nodiscard]] bool ReactToSignals();  // false: it is time to end
  void ReadSocket();
  void ReactToEmptyQueue(can::ReceiveStatus status, base::Time before);
  void ReactToTimer();
  void RunCycle(loop::Trigger trigger);
  void Send(std::span<const can::Frame> frames);
  void SendLastWords();
  void Arm(loop::Trigger last);
  void SetBus(BusState bus, const char* what);
  void Retry();

  loop::ServiceSettings settings_;
  loop::ControlLoop* loop_;
  std::function<void()> reload_;
  can::Socket socket_;
  base::FileDescriptor signals_;
  base::Timer timer_;
  base::Timer retry_timer_;
  base::FileDescriptor epoll_;
  EventLog log_;
  Notifier notifier_;
  Transmitter transmitter_;
  BusState bus_ = BusState::kUp;
  base::Time last_empty_{};     // when the receive queue was last seen empty
  base::Time state_arrival_{};  // of the newest complete state, by CLOCK_MONOTONIC even in lock step
  base::Latencies latencies_;
  std::int64_t cycles_ = 0;
};

}  // namespace lpvmpcd
