// Drives a scenario on a CAN interface, against a controller in another process.
//
//   const sim::Summary summary = sim::BusRun(scenario, bus, socket, settings).Run();
//
// In lock step the vehicle waits for the answer to each of its state sets, so the drive is as fast as both
// can and repeatable. Otherwise it keeps 20 Hz by the monotonic clock and applies commands as they come.
// SIGINT and SIGTERM, which the caller has to have blocked, end the drive where it is.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/socket.hpp"
#include "sim/scenario.hpp"
#include "sim/summary.hpp"
#include "sim/virtual_vehicle.hpp"

namespace sim {

struct BusRunSettings {
  bool lockstep = false;
  std::chrono::milliseconds controller_timeout{10'000};  // for a first ControllerStatus
  std::chrono::milliseconds answer_timeout{5'000};       // for the answer to a state set in lock step
};

// The kernel filters for what the vehicle wants to hear. Throws std::runtime_error if the bus lacks a message.
[[nodiscard]] std::vector<can::Filter> ControllerFilters(const bus::VehicleBus& bus);

class BusRun {
 public:
  // All references must outlive the run.
  BusRun(const Scenario& scenario, const bus::VehicleBus& bus, can::Socket& socket,
         const BusRunSettings& settings);
  ~BusRun();
  BusRun(const BusRun&) = delete;
  BusRun& operator=(const BusRun&) = delete;

  // Throws std::runtime_error: no controller, no answer in time, the interface is gone.
  [[nodiscard]] Summary Run();

  // Paced: cycles begun more than a period late.
  [[nodiscard]] std::uint64_t late_cycles() const { return late_cycles_; }
  [[nodiscard]] const VirtualVehicle& vehicle() const { return vehicle_; }

 private:
  using Clock = std::chrono::steady_clock;

  void WaitForController();
  void DriveInLockStep();
  void DrivePaced();
  // Handles what comes until `deadline` or until `until()`; true if the latter, or a signal, ended it.
  template <typename Condition>
  bool HandleUntil(Clock::time_point deadline, const Condition& until);
  void ReceiveAll();
  // True once every frame of the cycle is sent.
  bool SendCycle(Clock::time_point deadline);

  can::Socket* socket_;
  BusRunSettings settings_;
  VirtualVehicle vehicle_;
  Recorder recorder_;
  int signal_fd_;
  bool interrupted_ = false;
  std::uint64_t late_cycles_ = 0;
};

}  // namespace sim
