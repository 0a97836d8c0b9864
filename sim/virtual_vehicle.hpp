// The vehicle, its sensors, its perception and its driver as the bus sees them: frames out, frames in, on
// simulated time that advances by kCycleTime with every Advance().
//
//   sim::VirtualVehicle vehicle(scenario, bus);
//   while (...) {
//     for (const can::Frame& frame : vehicle.Sense(now)) Send(frame);
//     ... vehicle.Receive(frame) for every received frame, in lock step until vehicle.Answered() ...
//     vehicle.Advance();
//   }
//
// A command is obeyed while its message has Enable set and was renewed within the last kCommandLifetime cycles.
// Otherwise the driver at once holds the wheel where it is, whatever command is still on its way to the actuators. The
// driver leaves the pedals alone until the controller is first obeyed, and after that brakes gently to a stop.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"
#include "sim/actuator.hpp"
#include "sim/driver.hpp"
#include "sim/plant.hpp"
#include "sim/scenario.hpp"
#include "sim/sensors.hpp"
#include "sim/traffic.hpp"

namespace sim {

inline constexpr int kCommandLifetime = 10;          // [cycles]
inline constexpr double kDriverDeceleration = -2.0;  // demanded by a driver who has taken over [m/s²]
inline constexpr double kIntegrationStep = 1e-3;     // [s]

class VirtualVehicle {
 public:
  // `bus` must outlive the vehicle.
  VirtualVehicle(const Scenario& scenario, const bus::VehicleBus& bus);

  // Returns the frames of one cycle, stamped `now`; must be called once per cycle: DriverRequest, three of
  // ObstacleObject for each obstacle that has appeared and has not disappeared and each ghost, ObstacleList, then the state set:
  // VehiclePose, VehicleMotion, VehicleFeedback. They are valid until the next call. A message with a value that is not
  // finite is omitted.
  [[nodiscard]] std::span<const can::Frame> Sense(can::Time now);

  // Sets objects that are perceived beside the scenario's from now on, though they do not exist. Their ids must differ.
  void SetGhosts(std::vector<control::Obstacle> ghosts) { ghosts_ = std::move(ghosts); }

  // Takes a frame of the controller. A frame with a wrong CRC or of another sender has no effect.
  void Receive(const can::Frame& frame);

  // True once both commands that answer this cycle's state set, and a ControllerStatus after them, were received.
  [[nodiscard]] bool Answered() const {
    return steering_.answered && acceleration_.answered && status_after_;
  }

  // Applies the commands and simulates one cycle.
  void Advance();

  // Simulated time since the start [s].
  [[nodiscard]] double time() const { return static_cast<double>(cycle_) * kCycleTime; }
  // The true state.
  [[nodiscard]] const control::State& state() const { return plant_.state(); }
  [[nodiscard]] control::Input actuators() const {
    return {steering_actuator_.value(), acceleration_actuator_.value()};
  }
  // Those that exist, including those not yet perceived.
  [[nodiscard]] std::vector<control::Obstacle> ObstaclesNow() const { return traffic_.Now(); }
  // Those that exist and are perceived.
  [[nodiscard]] std::vector<control::Obstacle> PerceivedNow() const;
  // The commands last received, if both are to be obeyed.
  [[nodiscard]] std::optional<control::Input> commands() const;

  // The controller's last report.
  [[nodiscard]] bus::Mode mode() const { return status_.mode; }
  [[nodiscard]] const bus::ControllerStatus& status() const { return status_; }
  [[nodiscard]] bool status_is_new() const { return status_is_new_; }  // received since the last Advance()
  // The constraint that the controller reported as unmet since the last Advance(), if any.
  [[nodiscard]] const std::optional<bus::ConstraintReport>& unmet() const { return unmet_; }
  [[nodiscard]] bool heard() const { return heard_; }  // any status was received
  // Number of frames with a wrong CRC or length, or the invalid counter.
  [[nodiscard]] std::uint64_t rejected_frames() const { return rejected_frames_; }
  // Number of cycles in which a command was missing, after both were first obeyed.
  [[nodiscard]] std::uint64_t missed_commands() const { return missed_commands_; }

 private:
  // The last command of one of the two messages.
  struct Channel {
    bool enable = false;
    double value = 0.0;
    int age = kCommandLifetime;  // cycles since it was received
    bool answered = false;       // it answers this cycle's state set

    [[nodiscard]] bool Obeyed() const { return enable && age < kCommandLifetime; }
  };

  void Emit(const bus::Message& message, std::uint8_t counter, can::Time now);
  void EmitObstacles(can::Time now);
  [[nodiscard]] std::uint8_t StateCounter() const;
  template <typename Command>
  void Take(const Command& command, double value, Channel& channel) const;
  static void Apply(const Channel& channel, double by_driver, Actuator& actuator);

  const bus::VehicleBus* bus_;
  Plant plant_;
  Actuator steering_actuator_;
  Actuator acceleration_actuator_;
  Sensors sensors_;
  Driver driver_;
  Traffic traffic_;
  std::vector<control::Obstacle> ghosts_;

  std::int64_t cycle_ = 0;
  std::uint8_t request_counter_ = 0;
  std::uint8_t object_counter_ = 0;
  std::uint8_t list_counter_ = 0;
  std::vector<can::Frame> frames_;

  Channel steering_;
  Channel acceleration_;
  bool obeyed_ = false;  // both commands were obeyed at some time
  bus::ControllerStatus status_;
  bool status_is_new_ = false;
  std::optional<bus::ConstraintReport> unmet_;
  bool status_after_ = false;
  bool heard_ = false;
  std::uint64_t rejected_frames_ = 0;
  std::uint64_t missed_commands_ = 0;
};

}  // namespace sim
