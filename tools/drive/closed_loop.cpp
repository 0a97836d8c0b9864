#include "tools/drive/closed_loop.hpp"

#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/clock.hpp"
#include "base/time.hpp"
#include "loop/assembly.hpp"
#include "sim/recorder.hpp"
#include "sim/virtual_vehicle.hpp"
#include "tools/drive/make_controller.hpp"

namespace tools {

sim::Summary DriveClosedLoop(const sim::Scenario& scenario, const loop::Config& config,
                             const ClosedLoopHooks& hooks) {
  return DriveClosedLoop(scenario, config, config::LoadRoute(config.route), hooks);
}

sim::Summary DriveClosedLoop(const sim::Scenario& scenario, const loop::Config& config,
                             const config::RouteFile& route, const ClosedLoopHooks& hooks) {
  if (config.loop.period != base::FromSeconds(sim::kCycleTime)) {
    throw std::invalid_argument(
        fmt::format("the configuration's cycle.period = {} must be {} s, the simulated vehicle's",
                    std::chrono::duration<double>(config.loop.period).count(), sim::kCycleTime));
  }
  loop::Config untimed = config;  // the computer's speed must not change the drive
  untimed.loop.deadline = base::Time::max();
  const auto make = [&](const loop::Config& of, const loop::Road& road) {
    std::unique_ptr<control::Controller> law = tools::MakeController(of, road);
    if (hooks.qp && !law->SetQpObserver(hooks.qp)) {
      throw std::invalid_argument(
          fmt::format("controller {} solves no quadratic problem that could be recorded",
                      loop::ControllerName(of.controller)));
    }
    if (hooks.step) law = std::make_unique<ObservedController>(std::move(law), hooks.step);
    return law;
  };
  loop::Assembly controller(untimed, route, base::MonotonicNow, make);
  sim::VirtualVehicle vehicle(scenario, controller.bus());
  sim::Recorder recorder(scenario);
  const auto cycle = [&](base::Time now) {
    if (!hooks.cycle) return controller.loop().Cycle(now, loop::Trigger::kState);
    const base::Time wall = base::MonotonicNow(), processor = base::ThreadTimeNow();
    const std::span<const can::Frame> answers = controller.loop().Cycle(now, loop::Trigger::kState);
    const CycleTimes times{.wall = base::MonotonicNow() - wall,
                           .processor = base::ThreadTimeNow() - processor};
    hooks.cycle(times, controller.loop().report());
    return answers;
  };
  for (base::Time now{}; !recorder.finished(); now += config.loop.period) {
    if (hooks.sense) hooks.sense(vehicle);
    for (const can::Frame& frame : vehicle.Sense(can::Time(now))) {
      if (hooks.frame) hooks.frame(frame);
      if (!controller.loop().Receive(frame, now)) continue;
      for (can::Frame answer : cycle(now)) {
        answer.timestamp = can::Time(now);
        if (hooks.frame) hooks.frame(answer);
        vehicle.Receive(answer);
      }
    }
    recorder.Record(vehicle);
    if (hooks.stop && hooks.stop()) break;
    vehicle.Advance();
  }
  return recorder.Result();
}

}  // namespace tools
