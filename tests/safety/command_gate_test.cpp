#include "safety/command_gate.hpp"

#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "dbc/e2e.hpp"
#include "safety/mode_machine.hpp"

namespace safety {
namespace {

constexpr std::array kModes = {bus::Mode::kInit,     bus::Mode::kStandby,  bus::Mode::kActive,
                               bus::Mode::kDegraded, bus::Mode::kSafeStop, bus::Mode::kFault};

class CommandGateTest : public testing::Test {
 protected:
  bus::VehicleBus bus_;
  CommandGate gate_{bus_};
  CommandLimiter limiter_{{}};
  std::array<can::Frame, 2> frames_;

  bool Encode(const Answer& answer) {
    const auto limited = limiter_.Limit({0.125, -1.0}, {0.125, -1.0}, 0);
    return gate_.Encode(*limited.command, answer, frames_);
  }
  // One frame of each message that the gate encodes, in the order of a cycle.
  std::vector<can::Frame> OneOfEach() {
    EXPECT_TRUE(Encode({.mode = bus::Mode::kActive}));
    std::vector<can::Frame> frames(frames_.begin(), frames_.end());
    can::Frame frame;
    EXPECT_TRUE(gate_.Encode(bus::ControllerStatus{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(bus::SchedulingHealth{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(bus::ControllerDiagnostics{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(bus::ConstraintReport{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(bus::DisturbanceEstimate{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(bus::ManoeuvreStatus{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(bus::HorizonHeader{}, frame));
    frames.push_back(frame);
    return frames;
  }
  template <typename T>
  T Decode(const can::Frame& frame) const {
    return std::get<T>(*bus_.Decode(frame.id, frame.Payload()));
  }
};

TEST_F(CommandGateTest, CommandsSayWhatTheyAnswer) {
  for (const bus::Mode mode : kModes) {
    ASSERT_TRUE(Encode({.mode = mode, .state_counter = 9, .plan_age = 2}));
    const auto steering = Decode<bus::SteeringCommand>(frames_[0]);
    EXPECT_EQ(steering.mode, mode);
    EXPECT_EQ(steering.state_counter, 9);
    EXPECT_EQ(steering.plan_age, 2);
    EXPECT_NEAR(steering.delta, 0.125, 1e-6);
    const auto acceleration = Decode<bus::AccelerationCommand>(frames_[1]);
    EXPECT_EQ(acceleration.mode, mode);
    EXPECT_EQ(acceleration.state_counter, 9);
    EXPECT_EQ(acceleration.plan_age, 2);
    EXPECT_NEAR(acceleration.acceleration, -1.0, 1e-6);
  }
}

TEST_F(CommandGateTest, CommandsAreEnabledInTheModesThatCommandAlone) {
  EXPECT_TRUE(bus::Commands(bus::Mode::kActive) && bus::Commands(bus::Mode::kDegraded) &&
              bus::Commands(bus::Mode::kSafeStop));
  EXPECT_FALSE(bus::Commands(bus::Mode::kInit) || bus::Commands(bus::Mode::kStandby) ||
               bus::Commands(bus::Mode::kFault));
  for (const bus::Mode mode : kModes) {
    ASSERT_TRUE(Encode({.mode = mode}));
    EXPECT_EQ(Decode<bus::SteeringCommand>(frames_[0]).enable, bus::Commands(mode)) << static_cast<int>(mode);
    EXPECT_EQ(Decode<bus::AccelerationCommand>(frames_[1]).enable, bus::Commands(mode))
        << static_cast<int>(mode);
  }
}

TEST_F(CommandGateTest, AnswerToNothingSaysSo) {
  ASSERT_TRUE(Encode({}));
  const auto steering = Decode<bus::SteeringCommand>(frames_[0]);
  EXPECT_EQ(steering.mode, bus::Mode::kInit);
  EXPECT_EQ(steering.state_counter, 15);
  EXPECT_EQ(steering.plan_age, 63);
}

TEST_F(CommandGateTest, AgeBeyondWhatTheFrameHoldsIsItsLargest) {
  ASSERT_TRUE(Encode({.plan_age = 255}));
  EXPECT_EQ(Decode<bus::SteeringCommand>(frames_[0]).plan_age, 63);
  EXPECT_EQ(Decode<bus::AccelerationCommand>(frames_[1]).plan_age, 63);
}

TEST_F(CommandGateTest, EveryMessageHasItsOwnIdAndCounterAndIsProtected) {
  const std::array<const char*, 9> names = {
      "SteeringCommand",     "AccelerationCommand",   "ControllerStatus",
      "SchedulingHealth",    "ControllerDiagnostics", "ConstraintReport",
      "DisturbanceEstimate", "ManoeuvreStatus",       "PlannedHorizon"};
  for (std::uint8_t i = 0; i < 31; ++i) {
    const std::vector<can::Frame> frames = OneOfEach();
    for (std::size_t message = 0; message < frames.size(); ++message) {
      const can::Frame& frame = frames[message];
      EXPECT_EQ(bus_.Find(frame.id)->name, names[message]);
      const bus::E2eCheck check = bus_.Check(frame.id, frame.Payload());
      EXPECT_EQ(check.verdict, bus::E2eVerdict::kOk);
      EXPECT_EQ(check.counter, i % 15);
      EXPECT_TRUE(gate_.MaySend(frame));
    }
  }
}

TEST_F(CommandGateTest, HeaderAndPointsOfAHorizonShareTheirCounter) {
  can::Frame header;
  can::Frame point;
  ASSERT_TRUE(gate_.Encode(bus::HorizonHeader{.points = 9}, header));
  ASSERT_TRUE(gate_.Encode(bus::HorizonPoint{.index = 4, .X = 1.5, .Y = -2.0}, point));
  EXPECT_EQ(Decode<bus::HorizonHeader>(header).points, 9);
  EXPECT_EQ(Decode<bus::HorizonPoint>(point).index, 4);
  EXPECT_EQ(bus_.Check(header.id, header.Payload()).counter, 0);
  EXPECT_EQ(bus_.Check(point.id, point.Payload()).counter, 1);
}

TEST_F(CommandGateTest, ReportsSayWhatTheyAreGiven) {
  can::Frame frame;
  ASSERT_TRUE(gate_.Encode(bus::ControllerStatus{.mode = bus::Mode::kFault, .iterations = 7}, frame));
  EXPECT_EQ(Decode<bus::ControllerStatus>(frame).mode, bus::Mode::kFault);
  EXPECT_EQ(Decode<bus::ControllerStatus>(frame).iterations, 7);
  ASSERT_TRUE(gate_.Encode(bus::SchedulingHealth{.active_rows = 12}, frame));
  EXPECT_EQ(Decode<bus::SchedulingHealth>(frame).active_rows, 12);
  ASSERT_TRUE(gate_.Encode(bus::ControllerDiagnostics{.plans_refused = 5}, frame));
  EXPECT_EQ(Decode<bus::ControllerDiagnostics>(frame).plans_refused, 5);
}

TEST_F(CommandGateTest, FigureThatIsNoNumberIsNotSentAndCostsNoCounter) {
  can::Frame frame;
  EXPECT_FALSE(gate_.Encode(
      bus::SchedulingHealth{.scheduling_error = std::numeric_limits<double>::quiet_NaN()}, frame));
  EXPECT_EQ(frame.length, 0);
  ASSERT_TRUE(gate_.Encode(bus::SchedulingHealth{}, frame));
  EXPECT_EQ(bus_.Check(frame.id, frame.Payload()).counter, 0);
}

TEST_F(CommandGateTest, InfiniteCommandIsNotSentWhateverTheLimits) {
  const double infinity = std::numeric_limits<double>::infinity();
  const CommandLimiter limiter({.min_acceleration = infinity, .max_acceleration = infinity});
  const auto limited = limiter.Limit({0.0, 0.0}, {0.0, 0.0}, 0);
  ASSERT_EQ(limited.command->acceleration(), infinity);
  EXPECT_FALSE(gate_.Encode(*limited.command, {.mode = bus::Mode::kActive}, frames_));
}

TEST_F(CommandGateTest, OnlyTheDaemonsOwnMessagesMayBeSent) {
  for (const bus::MessageInfo& info : bus_.messages()) {
    can::Frame frame{.id = info.id, .length = info.length};
    frame.data[0] = std::byte{dbc::E2eProfile1Crc(info.data_id, frame.Payload())};
    const bool ours = bus_.database().Find(info.name)->transmitter == "Controller";
    EXPECT_EQ(gate_.MaySend(frame), ours) << info.name;
    frame.id = info.id + 0x400;
    EXPECT_FALSE(gate_.MaySend(frame)) << frame.id;
  }
}

TEST_F(CommandGateTest, OnlyStandardDataFramesMayBeSent) {
  for (const can::Frame& frame : OneOfEach()) {
    can::Frame other = frame;
    other.extended = true;
    EXPECT_FALSE(gate_.MaySend(other));
    other = frame;
    other.fd = true;
    EXPECT_FALSE(gate_.MaySend(other));
    for (const can::FrameKind kind : {can::FrameKind::kRemote, can::FrameKind::kError}) {
      other = frame;
      other.kind = kind;
      EXPECT_FALSE(gate_.MaySend(other));
    }
  }
}

TEST_F(CommandGateTest, FrameThatWasChangedSinceMayNotBeSent) {
  for (const can::Frame& frame : OneOfEach()) {
    for (const int length : {0, 7, 9}) {
      can::Frame other = frame;
      other.length = static_cast<std::uint8_t>(length);
      EXPECT_FALSE(gate_.MaySend(other));
    }
    for (unsigned bit = 0; bit < 64; ++bit) {
      can::Frame other = frame;
      other.data[bit / 8] ^= std::byte{1} << (bit % 8);
      EXPECT_FALSE(gate_.MaySend(other));
    }
  }
}

}  // namespace
}  // namespace safety
