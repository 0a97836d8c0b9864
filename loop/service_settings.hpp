// What the shell about the loop is configured with: interface, cycles by the timer, the process's share of the machine.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "base/time.hpp"

namespace loop {

struct RealTimeSettings {
  int fifo_priority = 0;     // of SCHED_FIFO, 1..99; 0: the usual scheduling
  bool lock_memory = false;  // all memory, present and to come, and a stack that has been touched
  std::vector<int> cpus;     // the only ones to run on; none: all that there are
};

struct ServiceSettings {
  std::string interface = "can0";
  base::Time period = std::chrono::milliseconds(50);   // of the cycles that the timer starts
  base::Time timeout = std::chrono::milliseconds(75);  // after a state, before the timer starts one
  // Time is the number of cycles times the period, so that a run with a plant that waits for its answers is
  // repeatable to the bit, however fast. The timer is a last resort then (kLockstepTimeout). No cycle runs before
  // the first state; until then the status alone is sent, so that the plant knows when to begin.
  bool lockstep = false;
  RealTimeSettings real_time;
};

}  // namespace loop
