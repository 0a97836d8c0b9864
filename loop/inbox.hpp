// Input from the bus: the message monitor checks each frame, its values go to the assembler of their kind, and each
// cycle takes a snapshot.
//
//   if (inbox.Receive(frame, now)) … = inbox.TakeSnapshot(now, Trigger::kState);
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "base/time.hpp"
#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"
#include "control/vehicle/types.hpp"
#include "loop/obstacle_assembler.hpp"
#include "loop/state_assembler.hpp"
#include "loop/step_counter.hpp"
#include "safety/faulty_message.hpp"
#include "safety/message_monitor.hpp"

namespace loop {

// The trigger of a cycle: a complete state set, or the timer if none came in time.
enum class Trigger : std::uint8_t { kState, kTimer };

// The inputs known at the start of a cycle.
struct Snapshot {
  base::Time now{};
  base::Time waited{};    // time since the state set that started the cycle was complete; 0 for the timer
  std::int64_t step = 0;  // periods since the loop began, by state counter and timer (StepCounter)

  VehicleState state;
  bool state_new = false;       // a state set was completed for this cycle
  bool state_fresh = false;     // known, or the model can tell from the last one
  bool state_rejected = false;  // a frame of its messages was refused recently

  std::span<const control::Obstacle> obstacles;  // owned by the inbox
  base::Time obstacle_age{};
  bool obstacles_fresh = false;

  bool request_fresh = false;
  bool engage = false;         // the last request
  bool released = false;       // engage was seen false since the last cycle
  bool override_seen = false;  // brake or steering override since the last cycle

  bool bus_up = true;
  bool silent = false;  // the bus has not been up for so long that another node may drive

  std::optional<safety::FaultyMessage> faulty_message;
};

class Inbox {
 public:
  // `period`: period of the state sets. `bus` must outlive the inbox.
  Inbox(const bus::VehicleBus& bus, const safety::MonitorSettings& settings, base::Time period);

  // True: a state set is complete and a cycle is due.
  [[nodiscard]] bool Receive(const can::Frame& frame, base::Time now);

  // Counts the step if the timer starts the cycle. An event between two cycles (a touch of the brake, a released
  // switch) appears in exactly one snapshot.
  [[nodiscard]] Snapshot TakeSnapshot(base::Time now, Trigger trigger);

  void Reconfigure(const safety::MonitorSettings& settings) { monitor_.Reconfigure(settings); }
  // False while the interface is down or gone.
  void SetBusUp(bool up) { bus_up_ = up; }

  [[nodiscard]] const safety::MessageMonitor& monitor() const { return monitor_; }
  [[nodiscard]] const ObstacleAssembler& obstacles() const { return obstacles_; }
  [[nodiscard]] const VehicleState& state() const { return states_.state(); }

 private:
  [[nodiscard]] bool TakeMessage(const safety::Accepted& accepted, base::Time now);

  base::Time period_;
  safety::MessageMonitor monitor_;
  StateAssembler states_;
  ObstacleAssembler obstacles_;
  StepCounter steps_;
  bus::DriverRequest request_;
  bool released_ = false;       // engage was seen false since the last cycle
  bool override_seen_ = false;  // brake or steering override since the last cycle
  base::Time completed_{};      // when the last state set was complete
  bool bus_up_ = true;
  base::Time last_up_{};  // time of the last cycle that found the bus up
};

}  // namespace loop
