// The daemon's control loop and the virtual vehicle joined by frames in memory: no bus, no clock, no sleep.
// It passes the frames on in the order of a lock-step run on a bus, so both give the same commands, bit for
// bit.
#pragma once

#include <functional>

#include "can/frame.hpp"
#include "daemon/config.hpp"
#include "sim/scenario.hpp"
#include "sim/summary.hpp"

namespace tools {

struct ClosedLoopHooks {
  std::function<void(const can::Frame&)> frame =
      nullptr;  // every frame of both sides, stamped with synthetic time
  std::function<void(const sim::Recorder&)> cycle = nullptr;  // after every cycle
};

// Drives the scenario to its end. Throws std::runtime_error, one line, if a file of the configuration is
// missing or wrong.
[[nodiscard]] sim::Summary DriveClosedLoop(const sim::Scenario& scenario, const lpvmpcd::Config& config,
                                           const ClosedLoopHooks& hooks = {});

}  // namespace tools
