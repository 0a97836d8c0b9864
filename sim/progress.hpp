// Shows the progress of a drive on stderr: one line, rewritten, on a terminal; a line every five seconds elsewhere.
#pragma once

#include <chrono>

#include "sim/recorder.hpp"
#include "sim/virtual_vehicle.hpp"

namespace sim {

class Progress {
 public:
  Progress();
  ~Progress();  // ends the terminal's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Show(const VirtualVehicle& vehicle, const Recorder& recorder);

 private:
  std::chrono::steady_clock::time_point next_;
  bool terminal_;
  bool shown_ = false;
};

}  // namespace sim
