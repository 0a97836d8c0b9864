// The way of a frame, from the bus to the bus:
//
//   Receive   frame ─► MessageMonitor ─► physical values ─► StateAssembler, ObstacleAssembler, driver's
//   request Cycle     what is known ─► plan ─► mode ─► command ─► CommandLimiter ─► CommandGate ─► frames
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

#include "can/frame.hpp"
#include "control/command_limiter.hpp"
#include "control/controller.hpp"
#include "control/reference.hpp"
#include "daemon/command_gate.hpp"
#include "daemon/message_monitor.hpp"
#include "daemon/mode_machine.hpp"
#include "daemon/obstacle_assembler.hpp"
#include "daemon/state_assembler.hpp"
#include "daemon/time.hpp"
#include "dbc/vehicle_bus.hpp"

namespace lpvmpcd {

struct LoopSettings {
  Time period = std::chrono::milliseconds(50);  // t_s, of the bus, the reference and the controller alike
  MonitorSettings monitor;
  control::CommandLimits limits;          // max_age is lowered to what the controller's horizon covers
  double stop_deceleration = 3.0;         // of SafeStop [m/s²], 0.1..10
  double standstill_speed = 0.3;          // below it the vehicle stands [m/s], 0..5
  double engage_min_speed = 3.0;          // [m/s], 0..50
  double engage_max_heading_error = 0.5;  // against the route [rad], 0..π
  bool send_horizon = true;               // PlannedHorizon frames
};

enum class Trigger : std::uint8_t { kState, kTimer };

// What happened in the last cycle, for a log.
struct CycleReport {
  Mode mode = Mode::kInit;
  Mode previous_mode = Mode::kInit;  // another one: the mode changed in this cycle
  Cause cause = Cause::kStart;       // of the present mode
  dbc::FaultCode fault = dbc::FaultCode::kNone;
  dbc::SolverStatus solver = dbc::SolverStatus::kNone;
  bool plan_accepted = false;
  bool engagement_refused = false;  // the driver asked in this cycle and did not get it
  int plan_age = -1;                // cycles, -1 without a plan
  int route_index = -1;             // point of the reference, -1 off the route
  bool limited = false;             // the limiter changed the command
  control::Input command = control::Input::Zero();
  Time step_time{};  // by the stopwatch
  std::uint64_t cycles = 0;
  std::uint64_t deadline_misses = 0;
  std::uint64_t solver_failures = 0;  // plans not accepted
};

class ControlLoop {
 public:
  // `stopwatch` tells a time of any start, for durations only. `bus`, `controller` and `reference` must
  // outlive the loop. Throws std::runtime_error: the bus lacks a message.
  ControlLoop(const LoopSettings& settings, const dbc::VehicleBus& bus, control::Controller& controller,
              const control::Reference& reference, const control::RoadBounds& road,
              std::function<Time()> stopwatch);

  // Takes a frame in. True: a state set is complete and a cycle is due.
  [[nodiscard]] bool Receive(const can::Frame& frame, Time now);

  // One control cycle. The frames to send, in this order: both commands, status, scheduling health, and with
  // a new plan its horizon. They belong to the loop and stay until the next call.
  [[nodiscard]] std::span<const can::Frame> Cycle(Time now, Trigger trigger);

  // A status alone, before the first cycle: somebody is here.
  [[nodiscard]] std::span<const can::Frame> Announce();

  // Both commands once more, not enabled: the last words of a daemon that ends.
  [[nodiscard]] std::span<const can::Frame> Disable();

  // False while the interface is down or gone.
  void SetBusUp(bool up) { bus_up_ = up; }

  [[nodiscard]] const CycleReport& report() const { return report_; }
  [[nodiscard]] const MessageMonitor& monitor() const { return monitor_; }
  [[nodiscard]] const CommandGate& gate() const { return gate_; }
  [[nodiscard]] const ObstacleAssembler& obstacles() const { return obstacles_; }
  [[nodiscard]] const VehicleState& state() const { return states_.state(); }
  [[nodiscard]] const LoopSettings& settings() const { return settings_; }

 private:
  void CountStep(Trigger trigger);
  [[nodiscard]] ModeInputs Judge(Time now, Trigger trigger);
  void Solve(bool engaging);
  [[nodiscard]] control::LimitResult Command() const;
  [[nodiscard]] control::LimitResult Measured() const;
  [[nodiscard]] dbc::FaultCode Fault(const ModeInputs& inputs) const;
  [[nodiscard]] bool Emit(const control::LimitedCommand& command, Trigger trigger);
  template <typename Message>
  void EmitReport(const Message& message);
  void EmitStatus();
  void EmitReports();

  [[nodiscard]] int PlanAge() const { return static_cast<int>(step_ - plan_step_); }
  [[nodiscard]] bool PlanCoversNow() const { return PlanAge() < static_cast<int>(plan_.size()); }

  LoopSettings settings_;
  control::Controller* controller_;
  const control::Reference* reference_;
  control::RoadBounds road_;
  std::function<Time()> stopwatch_;

  MessageMonitor monitor_;
  StateAssembler states_;
  ObstacleAssembler obstacles_;
  control::CommandLimiter limiter_;
  CommandGate gate_;

  bool bus_up_ = true;
  dbc::DriverRequest request_;
  bool released_ = false;       // since the last cycle
  bool override_seen_ = false;  // since the last cycle
  Time trigger_time_{};
  ModeState mode_;

  std::int64_t step_ = 0;         // t_s goes by from one to the next
  std::int64_t state_step_ = 0;   // of the last state set
  int state_counter_ = -1;        // of the last state set that was counted
  std::int64_t route_start_ = 0;  // reference point k belongs to step route_start_ + k

  std::vector<control::Input> plan_;                 // inputs of the last accepted plan; empty: none
  std::int64_t plan_step_ = 0;                       // the step at which it was made
  const control::Plan* new_plan_ = nullptr;          // of this cycle, if accepted
  const control::Plan* last_solve_ = nullptr;        // of this cycle, accepted or not
  control::Input applied_ = control::Input::Zero();  // last command in Active and SafeStop, else as measured

  std::vector<control::State> window_;
  std::vector<can::Frame> frames_;
  CycleReport report_;
};

}  // namespace lpvmpcd
