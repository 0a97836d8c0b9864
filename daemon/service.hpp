// The shell around the control loop: waits for frames, the timer and signals. All clocks of the daemon are read here.
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
  // Opens the interface and blocks the signals that Run handles. Throws std::runtime_error if the interface does not
  // exist, if it is not virtual in lock step, or if a system call fails. `loop` must outlive the service.
  Service(const loop::ServiceSettings& settings, loop::ControlLoop& loop, std::function<void()> reload);

  // Runs until SIGTERM or SIGINT, then sends a last pair of disabled commands. If the interface goes down or
  // disappears, the service waits for it. SIGUSR1 logs the latencies, SIGHUP calls `reload`. Throws
  // std::runtime_error if a system call fails.
  void Run();

 private:
  [[nodiscard]] base::Time Now() const;
  void BecomeRealTime();
  [[nodiscard]] bool ReactToSignals();  // false: the service is to stop
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
  base::Time state_arrival_{};  // arrival of the newest complete state; CLOCK_MONOTONIC even in lock step
  base::Latencies latencies_;
  std::int64_t cycles_ = 0;
};

}  // namespace lpvmpcd
