// Runs a scenario on a CAN interface, with the controller in another process.
//
//   const sim::Summary summary = sim::BusRun(scenario, bus, socket, settings).Run();
//
// In lock step the vehicle waits for the answer to each of its state sets, so the drive is repeatable and as
// fast as both processes permit. Otherwise it keeps 20 Hz by the monotonic clock and applies commands as they
// arrive. SIGINT and SIGTERM, which the caller must have blocked, end the drive where it is.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/socket.hpp"
#include "sim/recorder.hpp"
#include "sim/scenario.hpp"
#include "sim/summary.hpp"
#include "sim/virtual_vehicle.hpp"

namespace sim {

struct BusRunSettings {
  bool lockstep = false;
  std::chrono::milliseconds controller_timeout{10'000};  // longest wait for the first ControllerStatus
  std::chrono::milliseconds answer_timeout{5'000};       // longest wait for an answer in lock step
};

// The kernel filters for the messages that the vehicle receives.
[[nodiscard]] std::vector<can::Filter> ControllerFilters(const bus::VehicleBus& bus);

class BusRun {
 public:
  // All references must outlive the BusRun. `stop_signals`: a signalfd(2); a signal from it ends the run.
  BusRun(const Scenario& scenario, const bus::VehicleBus& bus, can::Socket& socket, int stop_signals,
         const BusRunSettings& settings);
  BusRun(const BusRun&) = delete;
  BusRun& operator=(const BusRun&) = delete;

  // Throws std::runtime_error if there is no controller, no answer in time, or an error of the interface.
  [[nodiscard]] Summary Run();

  // Number of cycles that began more than a period late; without lock step only.
  [[nodiscard]] std::uint64_t late_cycles() const { return late_cycles_; }
  [[nodiscard]] const VirtualVehicle& vehicle() const { return vehicle_; }

 private:
  using Clock = std::chrono::steady_clock;

  void WaitForController();
  void DriveInLockStep();
  void DrivePaced();
  // Handles received frames until `deadline` or until `until()` holds; false if the deadline ended it.
  template <typename Condition>
  bool HandleUntil(Clock::time_point deadline, const Condition& until);
  void ReceiveAll();
  // True if every frame of the cycle was sent, false if `deadline` came first. Throws std::runtime_error.
  bool SendCycle(Clock::time_point deadline);

  can::Socket* socket_;
  BusRunSettings settings_;
  VirtualVehicle vehicle_;
  Recorder recorder_;
  int stop_signals_;
  bool interrupted_ = false;
  std::uint64_t late_cycles_ = 0;
};

}  // namespace sim
