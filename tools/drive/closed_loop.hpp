// The daemon's control loop and the virtual vehicle, connected by frames in memory: no bus, no clock, no sleep. Frames
// are passed on in the order of a lock-step run on a bus, so both give the same commands bit for bit.
#pragma once

#include <functional>

#include "base/time.hpp"
#include "can/frame.hpp"
#include "config/route_file.hpp"
#include "loop/config.hpp"
#include "loop/cycle_report.hpp"
#include "sim/scenario.hpp"
#include "sim/summary.hpp"
#include "sim/virtual_vehicle.hpp"
#include "tools/drive/observed_controller.hpp"

namespace tools {

// The time that a control cycle took, from the complete state to the frames to be sent.
struct CycleTimes {
  base::Time wall{};
  base::Time processor{};  // without the time for which the thread had to wait for others
};

struct ClosedLoopHooks {
  // Called with every frame of both sides, stamped with synthetic time.
  std::function<void(const can::Frame&)> frame = nullptr;
  // Called after every step of the controller.
  std::function<void(const StepObservation&)> step = nullptr;
  // Called with every quadratic problem before it is solved. Requires a controller that solves quadratic problems.
  control::QpObserver qp = nullptr;
  // Called in every cycle before the vehicle measures and perceives.
  std::function<void(sim::VirtualVehicle&)> sense = nullptr;
  // Called after every control cycle with its times and its report.
  std::function<void(const CycleTimes&, const loop::CycleReport&)> cycle = nullptr;
  // Called after every cycle; true ends the drive.
  std::function<bool()> stop = nullptr;
};

// Drives the scenario to its end. Throws before anything is driven: std::runtime_error if a file of the configuration
// is missing or wrong; std::invalid_argument if its period is not the vehicle's, or if `hooks.qp` is set for a
// controller that solves no quadratic problem. The message is one line.
[[nodiscard]] sim::Summary DriveClosedLoop(const sim::Scenario& scenario, const loop::Config& config,
                                           const ClosedLoopHooks& hooks = {});
// Drives with the given route instead of the configuration's route file.
[[nodiscard]] sim::Summary DriveClosedLoop(const sim::Scenario& scenario, const loop::Config& config,
                                           const config::RouteFile& route, const ClosedLoopHooks& hooks = {});

}  // namespace tools
