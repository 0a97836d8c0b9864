// The shell about the control loop: waits for frames, the timer and signals, and has the only clocks of the
// daemon.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "can/socket.hpp"
#include "daemon/clock.hpp"
#include "daemon/control_loop.hpp"
#include "daemon/event_log.hpp"
#include "daemon/file_descriptor.hpp"
#include "daemon/latency_histogram.hpp"
#include "daemon/notifier.hpp"
#include "daemon/real_time.hpp"
#include "daemon/time.hpp"
#include "daemon/transmitter.hpp"

namespace lpvmpcd {

struct ServiceSettings {
  std::string interface;
  Time period = std::chrono::milliseconds(50);   // of the cycles that the timer starts
  Time timeout = std::chrono::milliseconds(75);  // after a state, before the timer starts one
  // Time is the number of cycles times the period, so that a run with a plant that waits for its answers is
  // repeatable to the bit, however fast. The timer is a last resort then (kLockstepTimeout). No cycle runs before
  // the first state; until then the status alone is sent, so that the plant knows when to begin.
  bool lockstep = false;
  RealTimeSettings real_time;
};

inline constexpr Time kLockstepTimeout = std::chrono::seconds(2);

class Service {
 public:
  // Opens the interface and blocks the signals that Run reacts to. Throws std::runtime_error: no such interface, one
  // that is not virtual for lock step, or a system call failed. `loop` must outlive the service.
  Service(const ServiceSettings& settings, ControlLoop& loop, std::function<void()> reload);

  // Until SIGTERM or SIGINT; then a last pair of commands, not enabled, is sent. An interface that goes down or away
  // is waited for. SIGUSR1 logs how quick the daemon has been, SIGHUP calls `reload`.
  void Run();

 private:
  [[nodiscard]] Time Now() const;
  void BecomeRealTime();
  [[nodiscard]] bool ReactToSignals();  // false: it is time to end
  void ReadSocket();
  void ReactToEmptyQueue(can::ReceiveStatus status, Time before);
  void ReactToTimer();
  void RunCycle(Trigger trigger);
  void Send(std::span<const can::Frame> frames);
  void SendLastWords();
  void Arm(Trigger last);
  void SetBus(BusState bus, const char* what);
  void Retry();

  ServiceSettings settings_;
  ControlLoop* loop_;
  std::function<void()> reload_;
  can::Socket socket_;
  FileDescriptor signals_;
  Timer timer_;
  Timer retry_timer_;
  FileDescriptor epoll_;
  EventLog log_;
  Notifier notifier_;
  Transmitter transmitter_;
  BusState bus_ = BusState::kUp;
  Time last_empty_{};     // when the receive queue was last seen empty
  Time state_arrival_{};  // of the newest complete state, by CLOCK_MONOTONIC even in lock step
  Latencies latencies_;
  std::int64_t cycles_ = 0;
};

}  // namespace lpvmpcd
