#include "sim/driver.hpp"

namespace sim {
namespace {

constexpr int kCyclesBeforeAsking = 5;  // in standby
constexpr int kCyclesOfPatience = 20;   // before asking anew

}  // namespace

bus::DriverRequest Driver::Request(double time, bus::Mode mode) {
  const auto reached = [time](const std::optional<double>& at) { return at && time >= *at; };
  bus::DriverRequest request;
  request.brake = reached(plan_.brake_at);
  request.steering_override = reached(plan_.steering_override_at);
  driven_ = driven_ || mode == bus::Mode::kActive;

  const bool done = request.brake || request.steering_override || reached(plan_.disengage_at);
  if (done || time < plan_.engage_at) {
    asking_ = false;
    cycles_ = 0;
  } else if (driven_) {
    asking_ = mode != bus::Mode::kInit && mode != bus::Mode::kFault && asking_;
  } else if (asking_) {
    if (++cycles_ >= kCyclesOfPatience) {
      asking_ = false;
      cycles_ = 0;
    }
  } else {
    cycles_ = mode == bus::Mode::kStandby ? cycles_ + 1 : 0;
    if (cycles_ >= kCyclesBeforeAsking) {
      asking_ = true;
      cycles_ = 0;
    }
  }
  request.engage = asking_;
  return request;
}

}  // namespace sim
