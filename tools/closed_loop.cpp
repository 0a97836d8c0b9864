#include "tools/closed_loop.hpp"

#include <chrono>
#include <fmt/format.h>
#include <stdexcept>

#include "daemon/assembly.hpp"
#include "daemon/service.hpp"
#include "daemon/time.hpp"
#include "sim/virtual_vehicle.hpp"

namespace tools {

sim::Summary DriveClosedLoop(const sim::Scenario& scenario, const lpvmpcd::Config& config,
                             const ClosedLoopHooks& hooks) {
  if (config.loop.period != lpvmpcd::FromSeconds(sim::kCycleTime)) {
    throw std::invalid_argument(
        fmt::format("the configuration's cycle.period = {} must be {} s, the simulated vehicle's",
                    std::chrono::duration<double>(config.loop.period).count(), sim::kCycleTime));
  }
  lpvmpcd::Assembly controller(config, lpvmpcd::MonotonicNow);
  sim::VirtualVehicle vehicle(scenario, controller.bus());
  sim::Recorder recorder(scenario);
  for (can::Time now{}; !recorder.finished(); now += config.loop.period) {
    for (const can::Frame& frame : vehicle.Sense(now)) {
      if (hooks.frame) hooks.frame(frame);
      if (!controller.loop().Receive(frame, now)) continue;
      for (can::Frame answer : controller.loop().Cycle(now, lpvmpcd::Trigger::kState)) {
        answer.timestamp = now;
        if (hooks.frame) hooks.frame(answer);
        vehicle.Receive(answer);
      }
    }
    recorder.Record(vehicle);
    if (hooks.cycle) hooks.cycle(recorder);
    vehicle.Advance();
  }
  return recorder.Result();
}

}  // namespace tools
