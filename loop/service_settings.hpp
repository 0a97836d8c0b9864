// Settings of the shell around the loop: interface, timer cycles, lock step, real-time options of the process.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "base/time.hpp"

namespace loop {

struct RealTimeSettings {
  int fifo_priority = 0;     // priority in SCHED_FIFO, 1..99; 0: the usual scheduling
  bool lock_memory = false;  // locks all present and future memory and touches the stack
  std::vector<int> cpus;     // the only CPUs to run on; empty: all
};

struct ServiceSettings {
  std::string interface = "can0";
  base::Time period = std::chrono::milliseconds(50);   // period of the cycles started by the timer
  base::Time timeout = std::chrono::milliseconds(75);  // time from a state to the first timer cycle
  // Time is the number of cycles times the period, so that a run with a plant that waits for the answers is bit-for-bit
  // repeatable at any speed. The timer is then only a last resort (kLockstepTimeout). No cycle runs before the first
  // state; until then only the status is sent, so that the plant knows when to begin.
  bool lockstep = false;
  RealTimeSettings real_time;
};

}  // namespace loop
