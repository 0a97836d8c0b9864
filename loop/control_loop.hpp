// The way of a frame, from the bus to the bus:
//
//   Receive   frame ─► Inbox: MessageMonitor ─► physical values ─► StateAssembler, ObstacleAssembler, driver's request
//   Cycle     Snapshot ─► RoutePlace ─► Outcome of planning ─► mode ─► LimitedCommand ─► frames
//             (Inbox)     (RouteTracker) (Planner)     (ModeMachine) (CommandSource)   (CommandGate, Reports)
//
// A cycle runs when the state set of a new counter is complete, and by a timer when none came in time. The
// loop reads no clock, does no I/O and logs nothing; after construction it does not allocate. So the daemon
// on a bus and a tool with the plant in memory run the very same loop.
//
//   ControlLoop loop(settings, bus, controller, reference, road, stopwatch);
//   if (loop.Receive(frame, now)) {
//     for (const can::Frame& answer : loop.Cycle(now, Trigger::kState)) Send(answer);
//   }
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/time.hpp"
#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"
#include "control/mpc/controller.hpp"
#include "control/mpc/plan_check.hpp"
#include "control/road/time_reference.hpp"
#include "control/vehicle/vehicle_parameters.hpp"
#include "loop/command_source.hpp"
#include "loop/inbox.hpp"
#include "loop/planner.hpp"
#include "loop/reports.hpp"
#include "loop/route_tracker.hpp"
#include "safety/command_gate.hpp"
#include "safety/command_limiter.hpp"
#include "safety/message_monitor.hpp"
#include "safety/mode_machine.hpp"

namespace loop {

struct LoopSettings {
  base::Time period =
      std::chrono::milliseconds(50);  // t_s, of the bus, the reference and the controller alike
  base::Time deadline =
      std::chrono::milliseconds(50);  // age of a state at which an answer to it comes too late
  safety::MonitorSettings monitor;
  safety::CommandLimits limits;  // max_age is lowered to what the controller's horizon covers
  safety::ModeSettings modes;
  control::VehicleParameters vehicle;     // for the steering of SafeStop
  double stop_deceleration = 3.0;         // of SafeStop [m/s²], 0.1..10
  double standstill_speed = 0.3;          // below it the vehicle stands [m/s], 0..5
  double engage_min_speed = 0.0;          // [m/s], 0..50
  double engage_max_heading_error = 0.5;  // against the route [rad], 0..π
  bool send_horizon = true;               // PlannedHorizon frames
  base::Time command_delay{};             // from a command to its effect
};

class ControlLoop {
 public:
  // `stopwatch` tells a time of any start, for durations only. `bus`, `controller`, `reference` and `check` must
  // outlive the loop. Without a check (null) a plan is followed if its figures are numbers. Throws std::runtime_error:
  // the bus lacks a message.
  ControlLoop(const LoopSettings& settings, const bus::VehicleBus& bus, control::Controller& controller,
              const control::TimeReference& reference, const control::RoadBounds& road,
              std::function<base::Time()> stopwatch, control::PlanCheck* check = nullptr);

  // Takes a frame in. True: a state set is complete and a cycle is due.
  [[nodiscard]] bool Receive(const can::Frame& frame, base::Time now);

  // One control cycle. The frames to send, in this order: both commands, status, scheduling health, diagnostics, constraint, and
  // with a new plan its horizon. They belong to the loop and stay until the next call. A state that has waited longer
  // than the deadline, here or while its plan was made, gets no answer: the last plan goes on, from where it is now.
  [[nodiscard]] std::span<const can::Frame> Cycle(base::Time now, Trigger trigger);

  // A status alone, before the first cycle: somebody is here.
  [[nodiscard]] std::span<const can::Frame> Announce();

  // Both commands once more, not enabled: the last words of a daemon that ends.
  [[nodiscard]] std::span<const can::Frame> Disable();

  // What the cycle before took, from the arrival of its state to both commands sent; to be published in the next.
  void SetCycleLatency(base::Time latency) { reports_.SetCycleLatency(latency); }

  // Takes over what of the settings can change while no commands are enabled: monitor, engagement, stop, and whether
  // the horizon is sent.
  void Reconfigure(const LoopSettings& settings);

  // False while the interface is down or gone.
  void SetBusUp(bool up) { inbox_.SetBusUp(up); }

  [[nodiscard]] const CycleReport& report() const { return reports_.report(); }
  [[nodiscard]] const safety::MessageMonitor& monitor() const { return inbox_.monitor(); }
  [[nodiscard]] const safety::CommandGate& gate() const { return gate_; }
  [[nodiscard]] const ObstacleAssembler& obstacles() const { return inbox_.obstacles(); }
  [[nodiscard]] const VehicleState& state() const { return inbox_.state(); }
  [[nodiscard]] const LoopSettings& settings() const { return settings_; }

 private:
  [[nodiscard]] safety::ModeInputs InputsOf(const Snapshot& known, const control::RoutePlace& place,
                                            const control::RouteProgress& progress) const;
  [[nodiscard]] PlanRequest RequestOf(const Snapshot& known, const safety::ModeInputs& inputs) const;
  [[nodiscard]] safety::LimitResult Issue(safety::ModeInputs& inputs, const Snapshot& known,
                                          const Outcome& outcome);
  [[nodiscard]] bool Encode(const safety::LimitResult& limited, const Snapshot& known,
                            const Outcome& outcome);

  LoopSettings settings_;
  Inbox inbox_;
  RouteTracker tracker_;
  Planner planner_;
  safety::ModeState mode_;
  CommandSource commands_;
  safety::CommandGate gate_;
  Reports reports_;
  std::vector<can::Frame> frames_;
};

}  // namespace loop
