// What the daemon says: a line for each event, at most one a second for events that come in numbers.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/control_loop.hpp"
#include "daemon/latency_histogram.hpp"
#include "daemon/time.hpp"

namespace lpvmpcd {

// Says how often something has happened, at most once a second.
class EventCount {
 public:
  // `total`: how often it has happened since start. True: `news` of it have not been told yet, and it is time.
  [[nodiscard]] bool Tell(std::uint64_t total, Time now, std::uint64_t& news);

 private:
  std::uint64_t told_ = 0;
  Time last_{};
};

class EventLog {
 public:
  // After a cycle: changes of mode, faults, refused engagements, refused frames, failed solves, missed deadlines.
  void Cycle(const ControlLoop& loop, Trigger trigger, Time now);
  // The kernel's count of frames lost because the receive buffer was full.
  void Dropped(std::uint64_t total, Time now);
  // Frames not sent because the transmit queue was full.
  void Unsent(std::uint64_t total, Time now);
  // How quick the daemon has been since its start.
  static void Times(const Latencies& latencies);

 private:
  void Constraint(const CycleReport& report, Time now);

  std::array<EventCount, kRxFaults> rx_faults_;
  EventCount lost_, rejected_lists_, plans_refused_, deadline_misses_, late_states_, dropped_, unsent_;
  std::uint64_t timer_cycles_ = 0;
  dbc::FaultCode told_fault_ = dbc::FaultCode::kNone;
  Time last_fault_{};
  bool constraint_told_ = false;
  Time last_constraint_{};
};

// Text of a fault code for people.
[[nodiscard]] std::string_view Name(dbc::FaultCode fault);
// The same of the present fault, with the message that ails, if one does.
[[nodiscard]] std::string FaultText(const CycleReport& report);

}  // namespace lpvmpcd
