#include "safety/message_monitor.hpp"

#include <array>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "dbc/parser.hpp"
#include "tests/bus/bus_frames.hpp"

namespace safety {
namespace {

using namespace std::chrono_literals;
using State = Health::State;

constexpr std::array kAllMessages = {RxMessage::kPose,         RxMessage::kMotion,
                                     RxMessage::kFeedback,     RxMessage::kObstacleObject,
                                     RxMessage::kObstacleList, RxMessage::kDriverRequest};

class MessageMonitorTest : public testing::Test {
 protected:
  bus::VehicleBus bus_;
  MessageMonitor monitor_{bus_, {}, 70ms};
  base::Time now_ = 1s;

  can::Frame Pose(std::uint8_t counter) const {
    return bus::MakeFrame(bus_, bus::VehiclePose{.X = 1.0}, counter);
  }
  // One frame of each message, in the order of RxMessage.
  std::vector<can::Frame> OneOfEach(std::uint8_t counter) const {
    return {Pose(counter),
            bus::MakeFrame(bus_, bus::VehicleMotion{}, counter),
            bus::MakeFrame(bus_, bus::VehicleFeedback{}, counter),
            bus::MakeFrame(bus_, bus::ObstacleMotion{}, counter),
            bus::MakeFrame(bus_, bus::ObstacleList{}, counter),
            bus::MakeFrame(bus_, bus::DriverRequest{}, counter)};
  }
  // `frame` with raw bits in one of its signals and a correct CRC.
  can::Frame With(can::Frame frame, const char* signal, std::uint64_t raw) const {
    const bus::MessageInfo& info = *bus_.Find(frame.id);
    const std::span payload(frame.data.data(), frame.length);
    dbc::WriteRaw(*bus_.database().Find(info.name)->Find(signal), raw, payload);
    frame.data[0] = std::byte{dbc::E2eProfile1Crc(info.data_id, payload)};
    return frame;
  }
  bool Accepts(const can::Frame& frame) {
    return std::holds_alternative<Accepted>(monitor_.Check(frame, now_));
  }
  // The fault of a frame that must be rejected; expects that this fault alone is counted.
  RxFault Refused(const can::Frame& frame) {
    std::array<std::uint64_t, kRxFaults> before{};
    for (std::size_t i = 0; i < kRxFaults; ++i) before[i] = monitor_.count(static_cast<RxFault>(i));
    const auto verdict = monitor_.Check(frame, now_);
    EXPECT_TRUE(std::holds_alternative<RxFault>(verdict));
    const RxFault* fault = std::get_if<RxFault>(&verdict);
    if (fault == nullptr) return {};
    for (std::size_t i = 0; i < kRxFaults; ++i) {
      const std::uint64_t expected = before[i] + (*fault == static_cast<RxFault>(i) ? 1 : 0);
      EXPECT_EQ(monitor_.count(static_cast<RxFault>(i)), expected);
    }
    return *fault;
  }
};

TEST_F(MessageMonitorTest, FirstFrameIsAcceptedWithAnyCounterAndDecoded) {
  const auto verdict = monitor_.Check(Pose(9), now_);
  const auto& accepted = std::get<Accepted>(verdict);
  EXPECT_EQ(accepted.kind, RxMessage::kPose);
  EXPECT_EQ(accepted.counter, 9);
  EXPECT_EQ(accepted.lost, 0);
  EXPECT_DOUBLE_EQ(std::get<bus::VehiclePose>(accepted.message).X, 1.0);
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

TEST_F(MessageMonitorTest, EveryMessageIsReceivedAndNamedAsInTheDbc) {
  const std::vector<can::Frame> frames = OneOfEach(5);
  const auto ids = monitor_.Ids();
  ASSERT_EQ(frames.size(), kRxMessages);
  for (std::size_t i = 0; i < kRxMessages; ++i) {
    EXPECT_EQ(std::get<Accepted>(monitor_.Check(frames[i], now_)).kind, kAllMessages[i]);
    EXPECT_EQ(ids[i], frames[i].id);
    EXPECT_EQ(Name(kAllMessages[i]), bus_.Find(frames[i].id)->name);
  }
}

TEST_F(MessageMonitorTest, EveryFaultHasItsName) {
  const std::array<const char*, kRxFaults> names = {
      "unknown id",       "wrong kind of frame", "wrong length",  "wrong CRC",         "invalid counter",
      "repeated counter", "counter jump",        "invalid value", "value out of range"};
  for (std::size_t i = 0; i < kRxFaults; ++i) EXPECT_EQ(Name(static_cast<RxFault>(i)), names[i]);
}

TEST_F(MessageMonitorTest, FrameOfNobodyIsUnknown) {
  can::Frame frame = Pose(0);
  frame.id = 0x7F0;
  EXPECT_EQ(Refused(frame), RxFault::kUnknown);
  EXPECT_EQ(Refused(bus::MakeFrame(bus_, bus::SteeringCommand{}, 0)), RxFault::kUnknown) << "our own message";
}

TEST_F(MessageMonitorTest, OnlyAStandardDataFrameIsTaken) {
  can::Frame frame = Pose(0);
  frame.extended = true;
  EXPECT_EQ(Refused(frame), RxFault::kWrongKind);
  frame = Pose(0);
  frame.kind = can::FrameKind::kRemote;
  EXPECT_EQ(Refused(frame), RxFault::kWrongKind);
  frame = Pose(0);
  frame.fd = true;
  EXPECT_EQ(Refused(frame), RxFault::kWrongKind);
  EXPECT_EQ(monitor_.HealthOf(RxMessage::kPose, now_).state, State::kRefused);
}

TEST_F(MessageMonitorTest, ErrorFrameIsNobodysWhateverNumberItBears) {
  can::Frame frame = Pose(0);
  frame.kind = can::FrameKind::kError;
  EXPECT_EQ(Refused(frame), RxFault::kWrongKind);
  EXPECT_EQ(monitor_.HealthOf(RxMessage::kPose, now_).state, State::kNeverSeen);
}

TEST_F(MessageMonitorTest, LengthIsThatOfTheDbc) {
  for (const int length : {0, 7, 9, 64}) {
    can::Frame frame = Pose(0);
    frame.length = static_cast<std::uint8_t>(length);
    EXPECT_EQ(Refused(frame), RxFault::kWrongLength);
  }
}

TEST_F(MessageMonitorTest, AnyFlippedBitOfThePayloadIsAWrongCrc) {
  for (unsigned bit = 0; bit < 64; ++bit) {
    can::Frame frame = Pose(0);
    frame.data[bit / 8] ^= std::byte{1} << (bit % 8);
    EXPECT_EQ(Refused(frame), RxFault::kWrongCrc);
  }
}

TEST_F(MessageMonitorTest, PayloadUnderTheIdOfAnotherMessageIsAWrongCrc) {
  can::Frame frame = Pose(0);
  frame.id = bus_.Info<bus::VehicleMotion>().id;
  EXPECT_EQ(Refused(frame), RxFault::kWrongCrc);
}

TEST_F(MessageMonitorTest, CounterOfFifteenIsInvalid) {
  EXPECT_EQ(Refused(With(Pose(0), "Counter", 15)), RxFault::kInvalidCounter);
}

TEST_F(MessageMonitorTest, ValueBeyondItsRangeIsRefused) {
  const can::Frame feedback = bus::MakeFrame(bus_, bus::VehicleFeedback{.delta = 0.1}, 3);
  EXPECT_EQ(Refused(With(feedback, "Psi", 125665)), RxFault::kOutOfRange);
  EXPECT_EQ(Refused(With(bus::MakeFrame(bus_, bus::VehicleFeedback{}, 4), "Psi", ~std::uint64_t{125664})),
            RxFault::kOutOfRange);
  EXPECT_EQ(monitor_.Age(RxMessage::kFeedback, now_), base::Time::max());
  EXPECT_TRUE(Accepts(With(bus::MakeFrame(bus_, bus::VehicleFeedback{}, 5), "Psi", 125664)));  // 3.1416
  EXPECT_EQ(Refused(With(bus::MakeFrame(bus_, bus::ObstacleShape{}, 0), "PassingSide", 3)),
            RxFault::kOutOfRange);
  EXPECT_EQ(Refused(With(bus::MakeFrame(bus_, bus::ObstacleMotion{}, 1), "Class", 5)), RxFault::kOutOfRange);
  EXPECT_TRUE(Accepts(bus::MakeFrame(bus_, bus::ObstacleList{.count = 64}, 0)));
  EXPECT_EQ(Refused(With(bus::MakeFrame(bus_, bus::ObstacleList{}, 1), "Count", 65)), RxFault::kOutOfRange);
}

TEST_F(MessageMonitorTest, ValueThatIsNotFiniteIsRefused) {
  std::string text(bus::BuiltInDbc());
  const std::string from =
      "X : 12|26@1- (0.0001,0) [-3355.4432|3355.4431] \"m\" Controller\n"
      " SG_ Y : 38|26@1- (0.0001,0) [-3355.4432|3355.4431]";
  const std::string to = "X : 12|20@1- (0.01,0) [0|0] \"m\" Controller\n SG_ Y : 32|32@1- (1,0) [0|0]";
  text.replace(text.find(from), from.size(), to);
  text += "SIG_VALTYPE_ 256 Y : 1;\n";
  bus_ = bus::VehicleBus(dbc::Parse(text, "foreign.dbc"));
  monitor_ = MessageMonitor(bus_, {}, 70ms);
  EXPECT_TRUE(Accepts(With(Pose(0), "Y", 0x7F7FFFFF)));  // the largest float32
  EXPECT_EQ(Refused(With(Pose(1), "Y", 0x7F800000)), RxFault::kOutOfRange);
  EXPECT_EQ(Refused(With(Pose(2), "Y", 0x7FC00000)), RxFault::kOutOfRange);
}

TEST_F(MessageMonitorTest, MultiplexorWithoutSuchValueIsRefused) {
  EXPECT_EQ(Refused(With(bus::MakeFrame(bus_, bus::ObstaclePosition{.object_id = 1}, 0), "Part", 3)),
            RxFault::kInvalidValue);
  EXPECT_EQ(monitor_.Age(RxMessage::kObstacleObject, now_), base::Time::max());
}

TEST_F(MessageMonitorTest, RepeatedCounterChangesNoValue) {
  EXPECT_TRUE(Accepts(Pose(3)));
  now_ += 10ms;
  EXPECT_EQ(Refused(Pose(3)), RxFault::kRepeated);
  EXPECT_EQ(monitor_.Age(RxMessage::kPose, now_), 10ms);
}

TEST_F(MessageMonitorTest, TwoLostFramesAreAcceptedAndReported) {
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

TEST_F(MessageMonitorTest, OneMessagesCounterIsNotAnothers) {
  EXPECT_TRUE(Accepts(Pose(3)));
  EXPECT_TRUE(Accepts(bus::MakeFrame(bus_, bus::VehicleMotion{}, 9)));
  EXPECT_TRUE(Accepts(Pose(4)));
}

TEST_F(MessageMonitorTest, EveryAdvanceOfTheCounterIsReportedOrRefused) {
  for (int max_lost = 0; max_lost <= 13; ++max_lost) {
    for (int from = 0; from < 15; ++from) {
      for (int advance = 0; advance < 15; ++advance) {
        MessageMonitor monitor(bus_, {.max_lost = max_lost}, 70ms);
        ASSERT_TRUE(
            std::holds_alternative<Accepted>(monitor.Check(Pose(static_cast<std::uint8_t>(from)), now_)));
        const auto verdict = monitor.Check(Pose(static_cast<std::uint8_t>((from + advance) % 15)), now_);
        if (advance == 0) {
          EXPECT_EQ(std::get<RxFault>(verdict), RxFault::kRepeated);
        } else if (advance > max_lost + 1) {
          EXPECT_EQ(std::get<RxFault>(verdict), RxFault::kCounterJump);
        } else {
          EXPECT_EQ(std::get<Accepted>(verdict).lost, advance - 1);
          EXPECT_EQ(monitor.lost(), static_cast<std::uint64_t>(advance - 1));
        }
      }
    }
  }
}

TEST_F(MessageMonitorTest, LostFramesAddUpOverAllMessages) {
  EXPECT_TRUE(Accepts(Pose(0)));
  EXPECT_TRUE(Accepts(Pose(2)));
  EXPECT_TRUE(Accepts(bus::MakeFrame(bus_, bus::DriverRequest{}, 0)));
  EXPECT_TRUE(Accepts(bus::MakeFrame(bus_, bus::DriverRequest{}, 3)));
  EXPECT_EQ(monitor_.lost(), 3U);
}

TEST_F(MessageMonitorTest, GapThatIsBridgedIsAsConfigured) {
  EXPECT_EQ(monitor_.max_state_gap(), 300ms);
  monitor_.Reconfigure({.max_state_gap = 0.1});
  EXPECT_EQ(monitor_.max_state_gap(), 100ms);
}

TEST_F(MessageMonitorTest, MessageIsStaleAfterThreePeriods) {
  EXPECT_FALSE(monitor_.Fresh(RxMessage::kPose, now_));
  EXPECT_TRUE(Accepts(Pose(0)));
  EXPECT_TRUE(monitor_.Fresh(RxMessage::kPose, now_ + 150ms));
  EXPECT_FALSE(monitor_.Fresh(RxMessage::kPose, now_ + 150ms + 1ns));
}

TEST_F(MessageMonitorTest, MessageWithoutPeriodInTheDbcHasTheDefaultOne) {
  EXPECT_EQ(monitor_.StaleAfter(RxMessage::kObstacleObject), 210ms);
  EXPECT_EQ(monitor_.StaleAfter(RxMessage::kObstacleList), 150ms);
}

TEST_F(MessageMonitorTest, SilentMessageIsNeverSeenThenFreshThenLate) {
  for (const RxMessage message : kAllMessages) {
    EXPECT_EQ(monitor_.HealthOf(message, now_).state, State::kNeverSeen);
  }
  for (const can::Frame& frame : OneOfEach(0)) EXPECT_TRUE(Accepts(frame));
  for (const RxMessage message : kAllMessages) {
    const base::Time stale = now_ + monitor_.StaleAfter(message);
    EXPECT_EQ(monitor_.HealthOf(message, stale).state, State::kFresh);
    EXPECT_EQ(monitor_.HealthOf(message, stale + 1ns).state, State::kLate);
    EXPECT_FALSE(monitor_.HealthOf(message, stale + 1ns).reason);
  }
}

TEST_F(MessageMonitorTest, PersistentlyBadCrcIsANamedFault) {
  EXPECT_TRUE(Accepts(Pose(0)));
  for (std::uint8_t counter = 1; counter <= 4; ++counter) {
    now_ += 50ms;
    can::Frame frame = Pose(counter);
    frame.data[0] ^= std::byte{1};
    EXPECT_EQ(Refused(frame), RxFault::kWrongCrc);
    const Health health = monitor_.HealthOf(RxMessage::kPose, now_);
    EXPECT_EQ(health.state, counter <= 3 ? State::kFresh : State::kRefused);
    EXPECT_EQ(health.reason, RxFault::kWrongCrc);
  }
  EXPECT_EQ(monitor_.HealthOf(RxMessage::kMotion, now_).state, State::kNeverSeen);
  EXPECT_FALSE(monitor_.HealthOf(RxMessage::kMotion, now_).reason);
}

TEST_F(MessageMonitorTest, CounterThatStandsStillIsANamedFault) {
  for (int i = 0; i < 5; ++i) {
    static_cast<void>(monitor_.Check(Pose(7), now_));
    now_ += 50ms;
  }
  const Health health = monitor_.HealthOf(RxMessage::kPose, now_);
  EXPECT_EQ(health.state, State::kRefused);
  EXPECT_EQ(health.reason, RxFault::kRepeated);
}

TEST_F(MessageMonitorTest, LastFaultIsTheReason) {
  EXPECT_EQ(Refused(With(Pose(0), "Counter", 15)), RxFault::kInvalidCounter);
  can::Frame frame = Pose(0);
  frame.length = 7;
  EXPECT_EQ(Refused(frame), RxFault::kWrongLength);
  EXPECT_EQ(monitor_.HealthOf(RxMessage::kPose, now_).reason, RxFault::kWrongLength);
}

TEST_F(MessageMonitorTest, RefusedMessageThatFallsSilentIsLate) {
  can::Frame frame = Pose(0);
  frame.data[0] ^= std::byte{1};
  EXPECT_EQ(Refused(frame), RxFault::kWrongCrc);
  EXPECT_EQ(monitor_.HealthOf(RxMessage::kPose, now_ + 150ms).state, State::kRefused);
  EXPECT_EQ(monitor_.HealthOf(RxMessage::kPose, now_ + 150ms + 1ns).state, State::kLate);
}

TEST_F(MessageMonitorTest, RefusedMessageThatRecoversIsFresh) {
  can::Frame frame = Pose(0);
  frame.data[0] ^= std::byte{1};
  EXPECT_EQ(Refused(frame), RxFault::kWrongCrc);
  EXPECT_TRUE(Accepts(Pose(1)));
  EXPECT_EQ(monitor_.HealthOf(RxMessage::kPose, now_).state, State::kFresh);
}

TEST_F(MessageMonitorTest, OtherSettingsHoldFromThenOnAndForgetNothing) {
  EXPECT_TRUE(Accepts(Pose(3)));
  monitor_.Reconfigure({.stale_periods = 5.0, .max_lost = 0});
  EXPECT_TRUE(monitor_.Fresh(RxMessage::kPose, now_ + 250ms));
  EXPECT_FALSE(monitor_.Fresh(RxMessage::kPose, now_ + 250ms + 1ns));
  EXPECT_FALSE(Accepts(Pose(5)));  // one is lost, and none is allowed
}

}  // namespace
}  // namespace safety
