// The way of a frame, from the bus to the bus:
//
//   Receive   frame ─► MessageMonitor ─► physical values ─► StateAssembler, ObstacleAssembler, driver's request
//   Cycle     what is known ─► plan ─► mode ─► command ─► CommandLimiter ─► CommandGate ─► frames
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
#include "control/road/path_stop.hpp"
#include "control/road/time_reference.hpp"
#include "control/vehicle/delay_compensator.hpp"
#include "control/vehicle/vehicle_parameters.hpp"
#include "loop/active_plan.hpp"
#include "loop/cycle_report.hpp"
#include "loop/obstacle_assembler.hpp"
#include "loop/state_assembler.hpp"
#include "loop/step_counter.hpp"
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
  double engage_min_speed = 3.0;          // [m/s], 0..50
  double engage_max_heading_error = 0.5;  // against the route [rad], 0..π
  bool send_horizon = true;               // PlannedHorizon frames
  bool by_progress = false;    // the reference goes on from the point beside the vehicle, not by time
  base::Time command_delay{};  // from a command to its effect
};

enum class Trigger : std::uint8_t { kState, kTimer };

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
  void SetCycleLatency(base::Time latency) { report_.cycle_latency = latency; }

  // Takes over what of the settings can change while no commands are enabled: monitor, engagement, stop, and whether
  // the horizon is sent.
  void Reconfigure(const LoopSettings& settings);

  // False while the interface is down or gone.
  void SetBusUp(bool up) { bus_up_ = up; }

  [[nodiscard]] const CycleReport& report() const { return report_; }
  [[nodiscard]] const safety::MessageMonitor& monitor() const { return monitor_; }
  [[nodiscard]] const safety::CommandGate& gate() const { return gate_; }
  [[nodiscard]] const ObstacleAssembler& obstacles() const { return obstacles_; }
  [[nodiscard]] const VehicleState& state() const { return states_.state(); }
  [[nodiscard]] const LoopSettings& settings() const { return settings_; }

 private:
  [[nodiscard]] safety::ModeInputs Judge(base::Time now, Trigger trigger);
  void TrackVehicle(const safety::ModeInputs& inputs, bool engaging);
  void Solve(base::Time now, bool engaging);
  void JudgePlan(bool late);
  [[nodiscard]] bool AtRouteEnd() const;
  [[nodiscard]] std::optional<safety::Cause> PlanFault(const safety::ModeInputs& inputs, bool late) const;
  [[nodiscard]] safety::LimitResult Command() const;
  [[nodiscard]] safety::LimitResult Measured() const;
  [[nodiscard]] bus::FaultCode Fault(const safety::ModeInputs& inputs) const;
  [[nodiscard]] base::Time Countdown(const safety::ModeInputs& inputs) const;
  [[nodiscard]] bool Emit(const safety::LimitedCommand& command, Trigger trigger);
  void EmitReports();

  LoopSettings settings_;
  control::Controller* controller_;
  const control::TimeReference* reference_;
  control::RoadBounds road_;
  std::function<base::Time()> stopwatch_;
  control::PlanCheck* check_;

  safety::MessageMonitor monitor_;
  StateAssembler states_;
  ObstacleAssembler obstacles_;
  safety::CommandLimiter limiter_;
  safety::CommandGate gate_;

  bool bus_up_ = true;
  base::Time last_sent_{};  // the last cycle that found the bus up
  bus::DriverRequest request_;
  bool released_ = false;       // since the last cycle
  bool override_seen_ = false;  // since the last cycle
  base::Time trigger_time_{};
  safety::ModeState mode_;

  StepCounter steps_;
  std::int64_t step_ = 0;         // of the command: later than the state's, if the cycle took that long
  std::int64_t route_start_ = 0;  // reference point k belongs to step route_start_ + k

  ActivePlan plan_;
  const control::Plan* solve_ = nullptr;             // of this cycle, accepted or not
  control::PathStop stop_;                           // knows where the vehicle is, and where the plan leads
  control::Input applied_ = control::Input::Zero();  // last command that was enabled, else as measured

  control::DelayCompensator delay_;
  base::Time cycle_start_{};                   // by the stopwatch
  std::function<bool()> time_left_;            // for another iteration
  control::State z_ = control::State::Zero();  // when the command of this cycle acts
  std::vector<control::Obstacle> moved_;       // the obstacles then

  std::vector<control::State> window_;
  std::vector<can::Frame> frames_;
  CycleReport report_;
};

}  // namespace loop
