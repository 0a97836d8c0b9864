#include "daemon/message_monitor.hpp"

#include <gtest/gtest.h>

#include "tests/daemon/bus_frames.hpp"

namespace lpvmpcd {
namespace {

using namespace std::chrono_literals;

class MessageMonitorTest : public testing::Test {
 protected:
  dbc::VehicleBus bus_;
  MessageMonitor monitor_{bus_, {}, 50ms};
  Time now_ = 1s;

  can::Frame Pose(std::uint8_t counter) const { return MakeFrame(bus_, dbc::VehiclePose{.X = 1.0}, counter); }
  bool Accepts(const can::Frame& frame) {
    return std::holds_alternative<Accepted>(monitor_.Check(frame, now_));
  }
  // The fault of a frame that must be refused.
  RxFault Refused(const can::Frame& frame) {
    const auto verdict = monitor_.Check(frame, now_);
    EXPECT_TRUE(std::holds_alternative<RxFault>(verdict));
    return std::holds_alternative<RxFault>(verdict) ? std::get<RxFault>(verdict) : RxFault{};
  }
};

TEST_F(MessageMonitorTest, FirstFrameIsAcceptedWithAnyCounterAndDecoded) {
  const auto verdict = monitor_.Check(Pose(9), now_);
  const auto& accepted = std::get<Accepted>(verdict);
  EXPECT_EQ(accepted.kind, RxMessage::kPose);
  EXPECT_EQ(accepted.counter, 9);
  EXPECT_EQ(accepted.lost, 0);
  EXPECT_DOUBLE_EQ(std::get<dbc::VehiclePose>(accepted.message).X, 1.0);
}

TEST_F(MessageMonitorTest, CounterWrapsAfterFourteen) {
  EXPECT_TRUE(Accepts(Pose(13)));
  EXPECT_TRUE(Accepts(Pose(14)));
  EXPECT_TRUE(Accepts(Pose(0)));
}

TEST_F(MessageMonitorTest, FrameThatFailsNeitherRefreshesItsMessageNorMovesTheCounter) {
  EXPECT_TRUE(Accepts(Pose(3)));
  now_ += 100ms;
  can::Frame corrupt = Pose(4);
  corrupt.data[5] ^= std::byte{0x10};
  EXPECT_EQ(Refused(corrupt), RxFault::kWrongCrc);
  EXPECT_EQ(monitor_.Age(RxMessage::kPose, now_), 100ms);
  EXPECT_TRUE(monitor_.RecentlyRejected(RxMessage::kPose, now_));
  EXPECT_FALSE(monitor_.RecentlyRejected(RxMessage::kMotion, now_));
  EXPECT_TRUE(Accepts(Pose(4)));
  EXPECT_EQ(monitor_.Age(RxMessage::kPose, now_), 0ms);
  EXPECT_EQ(monitor_.count(RxFault::kWrongCrc), 1U);
}

TEST_F(MessageMonitorTest, EveryFaultHasItsName) {
  can::Frame frame = Pose(0);
  frame.id = 0x7F0;
  EXPECT_EQ(Refused(frame), RxFault::kUnknown);

  frame = Pose(0);
  frame.extended = true;
  EXPECT_EQ(Refused(frame), RxFault::kWrongKind);
  frame = Pose(0);
  frame.kind = can::FrameKind::kRemote;
  EXPECT_EQ(Refused(frame), RxFault::kWrongKind);
  frame = Pose(0);
  frame.kind = can::FrameKind::kError;
  EXPECT_EQ(Refused(frame), RxFault::kWrongKind);
  frame = Pose(0);
  frame.fd = true;
  EXPECT_EQ(Refused(frame), RxFault::kWrongKind);

  frame = Pose(0);
  frame.length = 7;
  EXPECT_EQ(Refused(frame), RxFault::kWrongLength);

  // The payload of one message under the identifier of another: the data id gives it away.
  frame = Pose(0);
  frame.id = bus_.Find(std::string("VehicleMotion"))->id;
  EXPECT_EQ(Refused(frame), RxFault::kWrongCrc);

  frame = Pose(0);
  frame.data[1] |= std::byte{0x0F};
  const auto crc = dbc::E2eProfile1Crc(bus_.Find(frame.id)->data_id, frame.Payload());
  frame.data[0] = std::byte{crc};
  EXPECT_EQ(Refused(frame), RxFault::kInvalidCounter);
}

TEST_F(MessageMonitorTest, ValueThatItsTableDoesNotHoldIsRefused) {
  can::Frame frame = MakeFrame(bus_, dbc::ObstaclePosition{.object_id = 1}, 0);
  frame.data[1] |= std::byte{0x30};  // Part 3
  frame.data[0] = std::byte{dbc::E2eProfile1Crc(bus_.Find(frame.id)->data_id, frame.Payload())};
  EXPECT_EQ(Refused(frame), RxFault::kInvalidValue);
  EXPECT_EQ(monitor_.Age(RxMessage::kObstacleObject, now_), Time::max());
}

TEST_F(MessageMonitorTest, RepeatedCounterChangesNoValue) {
  EXPECT_TRUE(Accepts(Pose(3)));
  now_ += 10ms;
  EXPECT_EQ(Refused(Pose(3)), RxFault::kRepeated);
  EXPECT_EQ(monitor_.Age(RxMessage::kPose, now_), 10ms);
}

TEST_F(MessageMonitorTest, TwoLostFramesAreAcceptedAndTold) {
  EXPECT_TRUE(Accepts(Pose(3)));
  const auto verdict = monitor_.Check(Pose(6), now_);
  EXPECT_EQ(std::get<Accepted>(verdict).lost, 2);
  EXPECT_EQ(monitor_.lost(), 2U);
}

TEST_F(MessageMonitorTest, LargerJumpIsBelievedFromTheSecondFrameInSequenceOn) {
  EXPECT_TRUE(Accepts(Pose(3)));
  EXPECT_EQ(Refused(Pose(7)), RxFault::kCounterJump);
  EXPECT_EQ(Refused(Pose(8)), RxFault::kCounterJump);
  EXPECT_TRUE(Accepts(Pose(9)));
}

TEST_F(MessageMonitorTest, GapWhileResynchronisingBeginsAnew) {
  EXPECT_TRUE(Accepts(Pose(3)));
  EXPECT_EQ(Refused(Pose(7)), RxFault::kCounterJump);
  EXPECT_EQ(Refused(Pose(8)), RxFault::kCounterJump);
  EXPECT_EQ(Refused(Pose(10)), RxFault::kCounterJump);
  EXPECT_EQ(Refused(Pose(11)), RxFault::kCounterJump);
  EXPECT_TRUE(Accepts(Pose(12)));
}

TEST_F(MessageMonitorTest, MessageIsStaleAfterThreePeriods) {
  EXPECT_FALSE(monitor_.Fresh(RxMessage::kPose, now_));
  EXPECT_TRUE(Accepts(Pose(0)));
  EXPECT_TRUE(monitor_.Fresh(RxMessage::kPose, now_ + 150ms));
  EXPECT_FALSE(monitor_.Fresh(RxMessage::kPose, now_ + 150ms + 1ns));
}

}  // namespace
}  // namespace lpvmpcd
