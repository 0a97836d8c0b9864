// The person at the wheel, by a plan of times: engages the controller once it stands by, overrides or ends it.
//
// The controller engages on a rising edge of the request, and an edge that comes too early is spent. So the driver
// waits until the controller has stood by for a moment, asks, and asks again when nothing came of it; once driven
// and let go again, the driver keeps the wheel.
#pragma once

#include <optional>

#include "bus/messages.hpp"

namespace sim {

// Times since the start [s].
struct DriverPlan {
  double engage_at = 0.0;
  std::optional<double> disengage_at;
  std::optional<double> brake_at;
  std::optional<double> steering_override_at;
};

class Driver {
 public:
  explicit Driver(const DriverPlan& plan) : plan_(plan) {}

  // The request of one cycle at `time` [s], with the controller's mode as told last.
  [[nodiscard]] bus::DriverRequest Request(double time, bus::Mode mode);

 private:
  DriverPlan plan_;
  bool driven_ = false;  // the controller was active at some time
  int cycles_ = 0;       // since `asking_` changed, or the controller stands by
  bool asking_ = false;
};

}  // namespace sim
