// The report of a cycle, and the frames that carry it on the bus. It is written once per cycle and never read back by
// the loop.
#pragma once

#include <cstdint>
#include <vector>

#include "base/time.hpp"
#include "can/frame.hpp"
#include "control/road/route_place.hpp"
#include "loop/cycle_report.hpp"
#include "loop/inbox.hpp"
#include "loop/planner.hpp"
#include "safety/command_gate.hpp"
#include "safety/command_limiter.hpp"
#include "safety/mode_machine.hpp"

namespace loop {

// The results of a cycle.
struct CycleResult {
  const Snapshot& known;
  const control::RoutePlace& place;
  const control::RouteProgress& progress;
  const safety::ModeInputs& inputs;
  const Outcome& outcome;
  const safety::LimitResult& limited;
  const safety::ModeState& mode;
  const safety::ModeState& before;  // mode of the previous cycle
};

class Reports {
 public:
  explicit Reports(base::Time period) : period_(period) {}

  void Write(const CycleResult& result, const Planner& planner);
  // Appends only the status.
  void AppendStatus(safety::CommandGate& gate, std::vector<can::Frame>& frames) const;
  // Appends status, scheduling health, diagnostics, constraint, disturbance, manoeuvre, and with a new plan its
  // horizon if `send_horizon`.
  void AppendFrames(const CycleResult& result, bool send_horizon, safety::CommandGate& gate,
                    std::vector<can::Frame>& frames) const;

  // Time from the arrival of the last cycle's state to both commands sent; reported in the next cycle.
  void SetCycleLatency(base::Time latency) { cycle_latency_ = latency; }

  [[nodiscard]] const CycleReport& report() const { return report_; }

 private:
  [[nodiscard]] base::Time Countdown(const CycleResult& result) const;

  base::Time period_;
  base::Time cycle_latency_{};
  std::uint64_t cycles_ = 0;
  std::uint64_t deadline_misses_ = 0;
  CycleReport report_;
};

}  // namespace loop
