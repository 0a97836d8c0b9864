#include "daemon/command_gate.hpp"

#include <gtest/gtest.h>
#include <limits>

#include "daemon/mode_machine.hpp"

namespace lpvmpcd {
namespace {

class CommandGateTest : public testing::Test {
 protected:
  dbc::VehicleBus bus_;
  CommandGate gate_{bus_};
  control::CommandLimiter limiter_{{}};
  std::array<can::Frame, 2> frames_;

  bool Encode(Mode mode) {
    const auto limited = limiter_.Limit({0.125, -1.0}, {0.125, -1.0}, 0);
    return gate_.Encode(*limited.command, {.mode = mode, .state_counter = 9, .plan_age = 2}, frames_);
  }
  template <typename T>
  T Decode(const can::Frame& frame) const {
    return std::get<T>(*bus_.Decode(frame.id, frame.Payload()));
  }
};

TEST_F(CommandGateTest, EnablesInActiveDegradedAndSafeStopAlone) {
  for (const Mode mode :
       {Mode::kInit, Mode::kStandby, Mode::kActive, Mode::kDegraded, Mode::kSafeStop, Mode::kFault}) {
    ASSERT_TRUE(Encode(mode));
    const bool enable = mode == Mode::kActive || mode == Mode::kDegraded || mode == Mode::kSafeStop;
    const auto steering = Decode<dbc::SteeringCommand>(frames_[0]);
    EXPECT_EQ(steering.enable, enable);
    EXPECT_EQ(steering.mode, mode);
    EXPECT_EQ(steering.state_counter, 9);
    EXPECT_EQ(steering.plan_age, 2);
    EXPECT_NEAR(steering.delta, 0.125, 1e-6);
    const auto acceleration = Decode<dbc::AccelerationCommand>(frames_[1]);
    EXPECT_EQ(acceleration.enable, enable);
    EXPECT_EQ(acceleration.mode, mode);
    EXPECT_EQ(acceleration.state_counter, 9);
    EXPECT_NEAR(acceleration.acceleration, -1.0, 1e-6);
  }
}

TEST_F(CommandGateTest, CommandsAreProtectedEndToEnd) {
  for (std::uint8_t i = 0; i < 31; ++i) {
    ASSERT_TRUE(Encode(Mode::kActive));
    for (const can::Frame& frame : frames_) {
      const dbc::E2eCheck check = bus_.Check(frame.id, frame.Payload());
      EXPECT_EQ(check.verdict, dbc::E2eVerdict::kOk);
      EXPECT_EQ(check.counter, i % 15);
      EXPECT_TRUE(gate_.MaySend(frame));
    }
  }
}

TEST_F(CommandGateTest, FigureThatIsNoNumberIsNotSent) {
  can::Frame frame;
  EXPECT_FALSE(gate_.Encode(
      dbc::SchedulingHealth{.scheduling_error = std::numeric_limits<double>::quiet_NaN()}, frame));
}

TEST_F(CommandGateTest, OnlyTheDaemonsOwnMessagesMayBeSent) {
  can::Frame frame;
  ASSERT_TRUE(gate_.Encode(dbc::ControllerStatus{}, frame));
  EXPECT_TRUE(gate_.MaySend(frame));
  can::Frame other = frame;
  other.extended = true;
  EXPECT_FALSE(gate_.MaySend(other));
  other = frame;
  other.kind = can::FrameKind::kRemote;
  EXPECT_FALSE(gate_.MaySend(other));
  for (const dbc::MessageInfo& info : bus_.messages()) {
    frame.id = info.id;
    const bool ours = info.id >= 512;
    EXPECT_EQ(gate_.MaySend(frame), ours) << info.name;
  }
}

}  // namespace
}  // namespace lpvmpcd
