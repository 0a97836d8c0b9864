// The person at the wheel, who follows a plan of times: engages the controller once it is in standby, overrides it, or
// ends the drive.
//
// The controller engages on a rising edge of the request, and an edge that comes too early is lost. So the driver
// waits until the controller has been in standby for a moment, asks, and asks again if nothing happened. Once the
// controller has driven, the driver makes no new request: after it lets go, the driver keeps the wheel.
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

  // The request of one cycle at `time` [s], for the controller's mode as last reported.
  [[nodiscard]] bus::DriverRequest Request(double time, bus::Mode mode);

 private:
  DriverPlan plan_;
  bool driven_ = false;  // the controller was active at some time
  int cycles_ = 0;       // since `asking_` changed or standby began
  bool asking_ = false;
};

}  // namespace sim
