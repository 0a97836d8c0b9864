#include "daemon/transmitter.hpp"

#include <array>
#include <gtest/gtest.h>
#include <vector>

namespace lpvmpcd {
namespace {

using can::SendStatus;

// A queue that takes `room_` frames and then answers `otherwise_`.
class TransmitterTest : public testing::Test {
 protected:
  void Refill(int room) {
    room_ = room;
    sent_.clear();
  }

  int room_ = 100;
  SendStatus otherwise_ = SendStatus::kQueueFull;
  std::vector<std::uint32_t> sent_;
  bus::VehicleBus bus_;
  safety::CommandGate gate_{bus_};
  Transmitter transmitter_{gate_,
                           [this](const can::Frame& frame) {
                             if (room_ <= 0) return otherwise_;
                             --room_;
                             sent_.push_back(frame.id);
                             return SendStatus::kSent;
                           },
                           [this] {
                             return base::Time(static_cast<std::int64_t>(sent_.size()));
                           }};  // a clock that counts the frames sent
  const std::vector<can::Frame> pair_ = Commands();
  const std::vector<can::Frame> cycle_ = CommandsAndReports();
  static constexpr std::uint32_t kSteering = 512, kAcceleration = 513, kStatus = 528, kHealth = 529;

  std::vector<can::Frame> Commands() {
    std::array<can::Frame, 2> pair;
    const auto limited = safety::CommandLimiter({}).Limit({0.0, 0.0}, {0.0, 0.0}, 0);
    EXPECT_TRUE(gate_.Encode(*limited.command, {}, pair));
    return {pair.begin(), pair.end()};
  }
  std::vector<can::Frame> CommandsAndReports() {
    std::vector<can::Frame> frames = Commands();
    frames.resize(4);
    EXPECT_TRUE(gate_.Encode(bus::ControllerStatus{}, frames[2]));
    EXPECT_TRUE(gate_.Encode(bus::SchedulingHealth{}, frames[3]));
    return frames;
  }
};

TEST_F(TransmitterTest, AllFramesGoOutInOrder) {
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  EXPECT_EQ(sent_, (std::vector<std::uint32_t>{kSteering, kAcceleration, kStatus, kHealth}));
  EXPECT_EQ(transmitter_.unsent(), 0U);
}

TEST_F(TransmitterTest, TellsWhenBothCommandsHadLeftAndTheReportsHadNot) {
  transmitter_.Send(cycle_);
  EXPECT_EQ(transmitter_.commands_left(), base::Time(2));
  Refill(1);
  transmitter_.Send(cycle_);
  EXPECT_EQ(transmitter_.commands_left(), std::nullopt);
  Refill(2);
  transmitter_.Send(cycle_);
  EXPECT_EQ(transmitter_.commands_left(), base::Time(2));
}

TEST_F(TransmitterTest, QueueTooShortForTheReportsIsNoBusDown) {
  for (int i = 0; i < 10; ++i) {
    Refill(3);
    EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
    EXPECT_EQ(sent_, (std::vector<std::uint32_t>{kSteering, kAcceleration, kStatus}));
  }
  EXPECT_EQ(transmitter_.unsent(), 10U);
}

TEST_F(TransmitterTest, CommandsRefusedThreeTimesInARowAreABusDown) {
  Refill(0);
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  Refill(4);
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  Refill(1);  // a steering command alone is no pair
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kDown);
  EXPECT_EQ(transmitter_.last_status(), SendStatus::kQueueFull);
  Refill(2);
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
}

TEST_F(TransmitterTest, NothingFollowsAFrameThatIsNotSent) {
  int calls = 0;
  Transmitter transmitter(
      gate_,
      [&calls](const can::Frame&) { return ++calls == 1 ? SendStatus::kQueueFull : SendStatus::kSent; },
      [] { return base::Time{}; });
  transmitter.Send(cycle_);
  EXPECT_EQ(calls, 1);  // no acceleration command without its steering command
}

TEST_F(TransmitterTest, WhatTheGateDoesNotLetThroughIsNotSent) {
  std::vector<can::Frame> frames = cycle_;
  frames[0].data[3] ^= std::byte{1};
  EXPECT_EQ(transmitter_.Send(frames), BusState::kDown);
  EXPECT_EQ(transmitter_.last_status(), SendStatus::kInvalidFrame);
  EXPECT_FALSE(transmitter_.SendLast(frames, [] {}));
  frames = cycle_;
  frames[2].id = 0x100;
  EXPECT_EQ(transmitter_.Send(frames), BusState::kDown);
  EXPECT_EQ(sent_, (std::vector<std::uint32_t>{kSteering, kAcceleration}));
}

TEST_F(TransmitterTest, InterfaceThatIsDownOrGoneIsNamedAtOnceAndUpWithTheNextCommands) {
  for (const auto& [status, bus] : {std::pair(SendStatus::kInterfaceDown, BusState::kDown),
                                    std::pair(SendStatus::kInterfaceGone, BusState::kGone),
                                    std::pair(SendStatus::kInvalidFrame, BusState::kDown),
                                    std::pair(SendStatus::kError, BusState::kDown)}) {
    otherwise_ = status;
    Refill(0);
    EXPECT_EQ(transmitter_.Send(cycle_), bus);
    Refill(100);
    EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  }
}

TEST_F(TransmitterTest, LastWordsAreTriedAgainWhileTheQueueIsFull) {
  Refill(0);
  int waits = 0;
  EXPECT_TRUE(transmitter_.SendLast(pair_, [&] { room_ = ++waits % 5 == 0 ? 1 : 0; }));
  EXPECT_EQ(sent_, (std::vector<std::uint32_t>{kSteering, kAcceleration}));
  EXPECT_EQ(waits, 10);
}

TEST_F(TransmitterTest, LastWordsEndOnABusThatTakesNone) {
  Refill(0);
  int waits = 0;
  EXPECT_FALSE(transmitter_.SendLast(pair_, [&] { ++waits; }));
  EXPECT_EQ(waits, 99);
  otherwise_ = SendStatus::kInterfaceDown;
  waits = 0;
  EXPECT_FALSE(transmitter_.SendLast(pair_, [&] { ++waits; }));
  EXPECT_EQ(waits, 0);
}

}  // namespace
}  // namespace lpvmpcd
