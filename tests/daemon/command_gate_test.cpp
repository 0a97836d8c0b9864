#include "daemon/command_gate.hpp"

#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "daemon/mode_machine.hpp"
#include "dbc/e2e.hpp"

namespace lpvmpcd {
namespace {

constexpr std::array kModes = {Mode::kInit,     Mode::kStandby,  Mode::kActive,
                               Mode::kDegraded, Mode::kSafeStop, Mode::kFault};

class CommandGateTest : public testing::Test {
 protected:
  dbc::VehicleBus bus_;
  CommandGate gate_{bus_};
  control::CommandLimiter limiter_{{}};
  std::array<can::Frame, 2> frames_;

  bool Encode(const Answer& answer) {
    const auto limited = limiter_.Limit({0.125, -1.0}, {0.125, -1.0}, 0);
    return gate_.Encode(*limited.command, answer, frames_);
  }
  // A frame of each message that the gate makes, in the order of a cycle.
  std::vector<can::Frame> OneOfEach() {
    EXPECT_TRUE(Encode({.mode = Mode::kActive}));
    std::vector<can::Frame> frames(frames_.begin(), frames_.end());
    can::Frame frame;
    EXPECT_TRUE(gate_.Encode(dbc::ControllerStatus{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(dbc::SchedulingHealth{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(dbc::ControllerDiagnostics{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(dbc::ConstraintReport{}, frame));
    frames.push_back(frame);
    EXPECT_TRUE(gate_.Encode(dbc::HorizonHeader{}, frame));
    frames.push_back(frame);
    return frames;
  }
  template <typename T>
  T Decode(const can::Frame& frame) const {
    return std::get<T>(*bus_.Decode(frame.id, frame.Payload()));
  }
};

TEST_F(CommandGateTest, CommandsSayWhatTheyAnswer) {
  for (const Mode mode : kModes) {
    ASSERT_TRUE(Encode({.mode = mode, .state_counter = 9, .plan_age = 2}));
    const auto steering = Decode<dbc::SteeringCommand>(frames_[0]);
    EXPECT_EQ(steering.mode, mode);
    EXPECT_EQ(steering.state_counter, 9);
    EXPECT_EQ(steering.plan_age, 2);
    EXPECT_NEAR(steering.delta, 0.125, 1e-6);
    const auto acceleration = Decode<dbc::AccelerationCommand>(frames_[1]);
    EXPECT_EQ(acceleration.mode, mode);
    EXPECT_EQ(acceleration.state_counter, 9);
    EXPECT_EQ(acceleration.plan_age, 2);
    EXPECT_NEAR(acceleration.acceleration, -1.0, 1e-6);
  }
}

TEST_F(CommandGateTest, CommandsAreEnabledInTheModesThatCommandAlone) {
  EXPECT_TRUE(Commands(Mode::kActive) && Commands(Mode::kDegraded) && Commands(Mode::kSafeStop));
  EXPECT_FALSE(Commands(Mode::kInit) || Commands(Mode::kStandby) || Commands(Mode::kFault));
  for (const Mode mode : kModes) {
    ASSERT_TRUE(Encode({.mode = mode}));
    EXPECT_EQ(Decode<dbc::SteeringCommand>(frames_[0]).enable, Commands(mode)) << static_cast<int>(mode);
    EXPECT_EQ(Decode<dbc::AccelerationCommand>(frames_[1]).enable, Commands(mode)) << static_cast<int>(mode);
  }
}

TEST_F(CommandGateTest, AnswerToNothingSaysSo) {
  ASSERT_TRUE(Encode({}));
  const auto steering = Decode<dbc::SteeringCommand>(frames_[0]);
  EXPECT_EQ(steering.mode, Mode::kInit);
  EXPECT_EQ(steering.state_counter, 15);
  EXPECT_EQ(steering.plan_age, 63);
}

TEST_F(CommandGateTest, AgeBeyondWhatTheFrameHoldsIsItsLargest) {
  ASSERT_TRUE(Encode({.plan_age = 255}));
  EXPECT_EQ(Decode<dbc::SteeringCommand>(frames_[0]).plan_age, 63);
  EXPECT_EQ(Decode<dbc::AccelerationCommand>(frames_[1]).plan_age, 63);
}

TEST_F(CommandGateTest, EveryMessageHasItsOwnIdAndCounterAndIsProtected) {
  const std::array<const char*, 7> names = {"SteeringCommand",  "AccelerationCommand",   "ControllerStatus",
                                            "SchedulingHealth", "ControllerDiagnostics", "ConstraintReport",
                                            "PlannedHorizon"};
  for (std::uint8_t i = 0; i < 31; ++i) {
    const std::vector<can::Frame> frames = OneOfEach();
    for (std::size_t message = 0; message < frames.size(); ++message) {
      const can::Frame& frame = frames[message];
      EXPECT_EQ(bus_.Find(frame.id)->name, names[message]);
      const dbc::E2eCheck check = bus_.Check(frame.id, frame.Payload());
      EXPECT_EQ(check.verdict, dbc::E2eVerdict::kOk);
      EXPECT_EQ(check.counter, i % 15);
      EXPECT_TRUE(gate_.MaySend(frame));
    }
  }
}

TEST_F(CommandGateTest, HeaderAndPointsOfAHorizonShareTheirCounter) {
  can::Frame header;
  can::Frame point;
  ASSERT_TRUE(gate_.Encode(dbc::HorizonHeader{.points = 9}, header));
  ASSERT_TRUE(gate_.Encode(dbc::HorizonPoint{.index = 4, .X = 1.5, .Y = -2.0}, point));
  EXPECT_EQ(Decode<dbc::HorizonHeader>(header).points, 9);
  EXPECT_EQ(Decode<dbc::HorizonPoint>(point).index, 4);
  EXPECT_EQ(bus_.Check(header.id, header.Payload()).counter, 0);
  EXPECT_EQ(bus_.Check(point.id, point.Payload()).counter, 1);
}

TEST_F(CommandGateTest, ReportsSayWhatTheyAreGiven) {
  can::Frame frame;
  ASSERT_TRUE(gate_.Encode(dbc::ControllerStatus{.mode = Mode::kFault, .iterations = 7}, frame));
  EXPECT_EQ(Decode<dbc::ControllerStatus>(frame).mode, Mode::kFault);
  EXPECT_EQ(Decode<dbc::ControllerStatus>(frame).iterations, 7);
  ASSERT_TRUE(gate_.Encode(dbc::SchedulingHealth{.active_rows = 12}, frame));
  EXPECT_EQ(Decode<dbc::SchedulingHealth>(frame).active_rows, 12);
  ASSERT_TRUE(gate_.Encode(dbc::ControllerDiagnostics{.plans_refused = 5}, frame));
  EXPECT_EQ(Decode<dbc::ControllerDiagnostics>(frame).plans_refused, 5);
}

TEST_F(CommandGateTest, FigureThatIsNoNumberIsNotSentAndCostsNoCounter) {
  can::Frame frame;
  EXPECT_FALSE(gate_.Encode(
      dbc::SchedulingHealth{.scheduling_error = std::numeric_limits<double>::quiet_NaN()}, frame));
  EXPECT_EQ(frame.length, 0);
  ASSERT_TRUE(gate_.Encode(dbc::SchedulingHealth{}, frame));
  EXPECT_EQ(bus_.Check(frame.id, frame.Payload()).counter, 0);
}

TEST_F(CommandGateTest, InfiniteCommandIsNotSentWhateverTheLimits) {
  const double infinity = std::numeric_limits<double>::infinity();
  const control::CommandLimiter limiter({.min_acceleration = infinity, .max_acceleration = infinity});
  const auto limited = limiter.Limit({0.0, 0.0}, {0.0, 0.0}, 0);
  ASSERT_EQ(limited.command->acceleration(), infinity);
  EXPECT_FALSE(gate_.Encode(*limited.command, {.mode = Mode::kActive}, frames_));
}

TEST_F(CommandGateTest, OnlyTheDaemonsOwnMessagesMayBeSent) {
  for (const dbc::MessageInfo& info : bus_.messages()) {
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
}  // namespace lpvmpcd
