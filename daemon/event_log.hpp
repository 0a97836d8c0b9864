// Events in the daemon's log: one line per event, at most one per second for frequent events.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/latency_histogram.hpp"
#include "base/time.hpp"
#include "bus/decision_change.hpp"
#include "loop/control_loop.hpp"

namespace lpvmpcd {

// Reports how often something has happened, at most once a second.
class EventCount {
 public:
  // `total`: number of events since start. True if a report is due: `unreported` is the number of events not yet reported.
  [[nodiscard]] bool Due(std::uint64_t total, base::Time now, std::uint64_t& unreported);

 private:
  std::uint64_t reported_ = 0;
  base::Time last_{};
};

class EventLog {
 public:
  // Logs the events of a cycle: changes of mode, faults, refused engagements, frames refused or lost, rejected obstacle
  // lists, refused plans, unmet constraints, missed deadlines, missing states; and decisions about other things on the
  // road, each with its reason and once (bus/decision_change.hpp).
  void Cycle(const loop::ControlLoop& loop, loop::Trigger trigger, base::Time now);
  // `total`: frames that the kernel dropped because the receive buffer was full.
  void Dropped(std::uint64_t total, base::Time now);
  // `total`: frames not sent because the transmit queue was full.
  void Unsent(std::uint64_t total, base::Time now);
  // Logs the latencies since start.
  static void Times(const base::Latencies& latencies);

 private:
  void Constraint(const loop::CycleReport& report, base::Time now);

  bus::DecisionChange decision_;
  std::array<EventCount, safety::kRxFaults> rx_faults_;
  EventCount lost_, rejected_lists_, plans_refused_, deadline_misses_, late_states_, dropped_, unsent_;
  std::uint64_t timer_cycles_ = 0;
  bus::FaultCode reported_fault_ = bus::FaultCode::kNone;
  base::Time last_fault_{};
  bool constraint_reported_ = false;
  base::Time last_constraint_{};
};

// Text of the present fault, with the faulty message if there is one.
[[nodiscard]] std::string FaultText(const loop::CycleReport& report);

}  // namespace lpvmpcd
