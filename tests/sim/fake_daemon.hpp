// Stands in for the controller in tests: answers each state set, engages on a rising edge and follows the route.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"
#include "control/road/route.hpp"
#include "dbc/e2e.hpp"

namespace sim {

class FakeDaemon {
 public:
  FakeDaemon(const bus::VehicleBus& bus, const control::Route& route) : bus_(&bus), route_(route) {}

  // The answer if `frame` completes a state set; otherwise empty.
  std::vector<can::Frame> Receive(const can::Frame& frame) {
    const auto message = bus_->Decode(frame.id, frame.Payload());
    if (!message) return {};
    if (const auto* request = std::get_if<bus::DriverRequest>(&*message)) {
      if (request->engage && !engage_ && mode == bus::Mode::kStandby) mode = bus::Mode::kActive;
      if (!request->engage || request->brake || request->steering_override) mode = bus::Mode::kStandby;
      engage_ = request->engage;
    } else if (const auto* pose = std::get_if<bus::VehiclePose>(&*message)) {
      pose_ = *pose;
    } else if (const auto* feedback = std::get_if<bus::VehicleFeedback>(&*message)) {
      return Answer(*feedback, bus_->Check(frame.id, frame.Payload()).counter);
    }
    return {};
  }

  [[nodiscard]] std::vector<can::Frame> Answer(const bus::VehicleFeedback& feedback,
                                               std::uint8_t state_counter) {
    const control::RouteProjection place = route_.Project({pose_.X, pose_.Y}, hint_);
    hint_ = place.s;
    const control::RoutePoint ahead = route_.At(place.s + 3.0);
    const double heading_error = std::remainder(feedback.psi - route_.At(place.s).psi, 2.0 * M_PI);
    const double delta = steering.value_or(
        std::clamp(2.6 * ahead.curvature - 0.1 * place.lateral - 0.8 * heading_error, -0.5, 0.5));
    const bool enable = mode == bus::Mode::kActive;
    std::vector<can::Frame> frames{
        Encode(bus::SteeringCommand{
            .enable = enable, .mode = mode, .state_counter = state_counter, .plan_age = 0, .delta = delta}),
        Encode(bus::AccelerationCommand{.enable = enable,
                                        .mode = mode,
                                        .state_counter = state_counter,
                                        .plan_age = 0,
                                        .acceleration = acceleration}),
        Status()};
    if (constraint) frames.push_back(Encode(*constraint));
    return frames;
  }

  [[nodiscard]] can::Frame Status() {
    ++counter_;
    return Encode(bus::ControllerStatus{.mode = mode,
                                        .fault_code = fault_code,
                                        .solver_status = solver_status,
                                        .iterations = 5,
                                        .solve_time = 1e-6 * static_cast<double>(counter_ % 100 + 1),
                                        .deadline_misses = deadline_misses});
  }

  [[nodiscard]] can::Frame Encode(const bus::Message& message) const {
    bus::RawMessage raw;
    (void)bus_->Encode(message, static_cast<std::uint8_t>(counter_ % dbc::kCounterModulus), raw);
    can::Frame frame;
    frame.id = raw.id;
    frame.length = raw.length;
    std::ranges::copy(raw.data, frame.data.begin());
    return frame;
  }

  bus::Mode mode = bus::Mode::kStandby;
  bus::SolverStatus solver_status = bus::SolverStatus::kSolved;
  std::uint16_t deadline_misses = 0;
  bus::FaultCode fault_code = bus::FaultCode::kNone;
  double acceleration = 0.0;                        // commanded [m/s²]
  std::optional<double> steering;                   // commanded instead of following the route [rad]
  std::optional<bus::ConstraintReport> constraint;  // no report is sent if empty

 private:
  const bus::VehicleBus* bus_;
  control::Route route_;
  std::optional<double> hint_;
  bool engage_ = false;
  bus::VehiclePose pose_;
  unsigned counter_ = 0;
};

}  // namespace sim
