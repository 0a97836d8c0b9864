// The control loop, from received to sent frames:
//
//   Receive   frame ─► Inbox: MessageMonitor ─► physical values ─► StateAssembler, ObstacleAssembler, driver's request
//   Cycle     Snapshot ─► RoutePlace ─► Outcome of planning ─► mode ─► LimitedCommand ─► frames
//             (Inbox)     (RouteTracker) (Planner)     (ModeMachine) (CommandSource)   (CommandGate, Reports)
//
// A cycle runs when the state set of a new counter is complete, or on a timer if none came in time. The loop reads no
// clock but the given stopwatch, does no I/O and logs nothing; after construction it does not allocate. The daemon on a
// bus and a tool with the plant in memory therefore run the same loop.
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
#include "control/road/road_profile.hpp"
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
  base::Time period = std::chrono::milliseconds(50);    // t_s of bus, reference and controller
  base::Time deadline = std::chrono::milliseconds(50);  // age of a state beyond which an answer to it is late
  safety::MonitorSettings monitor;
  safety::CommandLimits limits;  // max_age is lowered to what the controller's horizon covers
  safety::ModeSettings modes;
  control::VehicleParameters vehicle;     // model of odometer, delay compensation and SafeStop
  double stop_deceleration = 3.0;         // deceleration in SafeStop [m/s²], 0.1..10
  double standstill_speed = 0.3;          // speed below which the vehicle stands [m/s], 0..5
  double engage_min_speed = 0.0;          // [m/s], 0..50
  double engage_max_heading_error = 0.5;  // relative to the route [rad], 0..π
  bool send_horizon = true;               // whether PlannedHorizon frames are sent
  base::Time command_delay{};             // time from a command to its effect
  bool offset_free = false;               // whether disturbances are estimated and counted with
  double mu = 0.7;                        // assumed friction coefficient of the road
};

class ControlLoop {
 public:
  // `stopwatch` returns the time since an arbitrary start, for durations only. `bus`, `controller`, `reference`,
  // `profile` and `check` must outlive the loop. Without a check (null) a plan is followed if its values are finite.
  ControlLoop(const LoopSettings& settings, const bus::VehicleBus& bus, control::Controller& controller,
              const control::TimeReference& reference, const control::RoadProfile& profile,
              std::function<base::Time()> stopwatch, control::PlanCheck* check = nullptr);

  // Processes a frame. True: a state set is complete and a cycle is due.
  [[nodiscard]] bool Receive(const can::Frame& frame, base::Time now);

  // Runs one control cycle and returns the frames to send, in this order: both commands, status, scheduling health,
  // diagnostics, constraint, disturbance, and with a new plan its horizon. They belong to the loop and are valid until the next
  // call. A state that has waited longer than the deadline, before the cycle or while its plan was made, is not
  // answered: the active plan continues at the step that is due by then.
  [[nodiscard]] std::span<const can::Frame> Cycle(base::Time now, Trigger trigger);

  // Returns only a status frame, which shows before the first cycle that the daemon is running.
  [[nodiscard]] std::span<const can::Frame> Announce();

  // Returns both commands, disabled: the last frames of a daemon that stops.
  [[nodiscard]] std::span<const can::Frame> Disable();

  // Latency of the last cycle, from the arrival of its state to both commands sent; reported in the next cycle.
  void SetCycleLatency(base::Time latency) { reports_.SetCycleLatency(latency); }

  // Applies the settings that can change while commands are disabled: monitor, engagement, modes, stop, and whether the
  // horizon is sent. The others must be unchanged.
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
  void AddPlan(const Outcome& outcome, safety::ModeInputs& inputs) const;
  [[nodiscard]] safety::LimitResult Issue(const Snapshot& known, const control::RoutePlace& place,
                                          const Outcome& outcome, const control::Input& applied,
                                          safety::ModeInputs& inputs);
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
