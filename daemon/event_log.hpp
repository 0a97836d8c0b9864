// What the daemon says: a line for each event, at most one a second for events that come in numbers.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/latency_histogram.hpp"
#include "base/time.hpp"
#include "loop/control_loop.hpp"

namespace lpvmpcd {

// Says how often something has happened, at most once a second.
class EventCount {
 public:
  // `total`: how often it has happened since start. True: `news` of it have not been told yet, and it is time.
  [[nodiscard]] bool Tell(std::uint64_t total, base::Time now, std::uint64_t& news);

 private:
  std::uint64_t told_ = 0;
  base::Time last_{};
};

class EventLog {
 public:
  // After a cycle: changes of mode, faults, refused engagements, refused frames, failed solves, missed deadlines.
  void Cycle(const loop::ControlLoop& loop, loop::Trigger trigger, base::Time now);
  // The kernel's count of frames lost because the receive buffer was full.
  void Dropped(std::uint64_t total, base::Time now);
  // Frames not sent because the transmit queue was full.
  void Unsent(std::uint64_t total, base::Time now);
  // How quick the daemon has been since its start.
  static void Times(const base::Latencies& latencies);

 private:
  void Constraint(const loop::CycleReport& report, base::Time now);

  std::array<EventCount, safety::kRxFaults> rx_faults_;
  EventCount lost_, rejected_lists_, plans_refused_, deadline_misses_, late_states_, dropped_, unsent_;
  std::uint64_t timer_cycles_ = 0;
  bus::FaultCode told_fault_ = bus::FaultCode::kNone;
  base::Time last_fault_{};
  bool constraint_told_ = false;
  base::Time last_constraint_{};
};

// Text of the present fault, with the message that ails, if one does.
[[nodiscard]] std::string FaultText(const loop::CycleReport& report);

}  // namespace lpvmpcd
