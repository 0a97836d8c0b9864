// A control loop with a controller that answers as it is set up to, and a vehicle that sends its frames.
#pragma once

#include <gtest/gtest.h>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "loop/control_loop.hpp"
#include "tests/bus/bus_frames.hpp"
#include "tests/loop/fake_controller.hpp"

namespace loop {

using namespace std::chrono_literals;

class ControlLoopTest : public testing::Test {
 protected:
  static constexpr std::size_t kWithoutHorizon = 8;  // frames of a cycle
  struct Sent {
    bus::SteeringCommand steering;
    bus::AccelerationCommand acceleration;
    bus::ControllerStatus status;
    bus::ControllerDiagnostics diagnostics;
    bus::ManoeuvreStatus manoeuvre;
    std::size_t frames = 0;
  };

  template <typename T>
  T Decode(const can::Frame& frame) const {
    EXPECT_EQ(bus_.Check(frame.id, frame.Payload()).verdict, bus::E2eVerdict::kOk);
    return std::get<T>(*bus_.Decode(frame.id, frame.Payload()));
  }
  // Reads what a cycle sent, and holds what holds in every cycle.
  Sent Read(std::span<const can::Frame> frames) const {
    Sent sent;
    sent.frames = frames.size();
    EXPECT_GE(frames.size(), kWithoutHorizon);
    sent.steering = Decode<bus::SteeringCommand>(frames[0]);
    sent.acceleration = Decode<bus::AccelerationCommand>(frames[1]);
    sent.status = Decode<bus::ControllerStatus>(frames[2]);
    sent.diagnostics = Decode<bus::ControllerDiagnostics>(frames[4]);
    sent.manoeuvre = Decode<bus::ManoeuvreStatus>(frames[7]);
    const bool enabled = sent.steering.mode == bus::Mode::kActive ||
                         sent.steering.mode == bus::Mode::kDegraded ||
                         sent.steering.mode == bus::Mode::kSafeStop;
    EXPECT_EQ(sent.steering.enable, enabled);
    EXPECT_EQ(sent.acceleration.enable, enabled);
    EXPECT_EQ(sent.acceleration.mode, sent.steering.mode);
    EXPECT_EQ(sent.status.mode, sent.steering.mode);
    EXPECT_EQ(sent.acceleration.state_counter, sent.steering.state_counter);
    EXPECT_EQ(sent.acceleration.plan_age, sent.steering.plan_age);
    return sent;
  }
  // Gives frames to the loop; the cycle that they ask for.
  Sent Give(const std::vector<can::Frame>& frames) {
    Sent sent;
    for (const can::Frame& frame : frames) {
      if (loop_.Receive(frame, now_)) {
        sent = Read(loop_.Cycle(now_, Trigger::kState));
      }
    }
    return sent;
  }
  // One period with everything in it.
  Sent Period() {
    Advance();
    return Give(vehicle_.All());
  }
  // One period in which the state stays away.
  Sent TimerPeriod() {
    Advance();
    vehicle_.SkipState();
    EXPECT_EQ(Give(vehicle_.Request()).frames, 0U);
    EXPECT_EQ(Give(vehicle_.Obstacles()).frames, 0U);
    return Read(loop_.Cycle(now_, Trigger::kTimer));
  }
  void Advance() {
    now_ += 50ms;
    vehicle_.pose.X += 0.5;
  }
  Sent Engage() {
    for (int i = 0; i < 5; ++i) {
      Period();
    }
    EXPECT_EQ(loop_.report().mode, bus::Mode::kStandby);
    vehicle_.request.engage = true;
    return Period();
  }

  bus::VehicleBus bus_;
  FakeController controller_;
  control::TimeReference reference_{StraightRoute(), 0.05};
  control::RoadProfile profile_{StraightOn(), {}, {}};
  base::Time stopwatch_step_ = 0ms;  // by which the stopwatch goes on each time it is read
  base::Time stopwatch_{};
  control::TimedController timed_{std::make_unique<Forwarding>(controller_), reference_, {}};
  ControlLoop loop_{{}, bus_, timed_, reference_, profile_, [this] { return stopwatch_ += stopwatch_step_; }};
  bus::FakeVehicle vehicle_{bus_};
  base::Time now_ = 10s;
};

}  // namespace loop
