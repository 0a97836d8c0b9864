#include "daemon/transmitter.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace lpvmpcd {
namespace {

using can::SendStatus;

// A queue that takes a number of frames and then answers `otherwise`.
class TransmitterTest : public testing::Test {
 protected:
  void Refill(int room) {
    room_ = room;
    sent_.clear();
  }

  int room_ = 100;
  SendStatus otherwise_ = SendStatus::kQueueFull;
  std::vector<std::uint32_t> sent_;
  Transmitter transmitter_{[this](const can::Frame& frame) {
    if (room_ <= 0) return otherwise_;
    --room_;
    sent_.push_back(frame.id);
    return SendStatus::kSent;
  }};
  const std::vector<can::Frame> cycle_{{.id = 1}, {.id = 2}, {.id = 3}, {.id = 4}};
  const std::vector<can::Frame> pair_{{.id = 1}, {.id = 2}};
};

TEST_F(TransmitterTest, AllFramesGoOutInOrder) {
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  EXPECT_EQ(sent_, (std::vector<std::uint32_t>{1, 2, 3, 4}));
  EXPECT_EQ(transmitter_.unsent(), 0U);
}

TEST_F(TransmitterTest, QueueTooShortForTheReportsIsNoBusDown) {
  for (int i = 0; i < 10; ++i) {
    Refill(3);
    EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
    EXPECT_EQ(sent_, (std::vector<std::uint32_t>{1, 2, 3}));
  }
  EXPECT_EQ(transmitter_.unsent(), 10U);
}

TEST_F(TransmitterTest, CommandsRefusedThreeTimesInARowAreABusDown) {
  Refill(0);
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  Refill(4);
  EXPECT_EQ(transmitter_.Send(cycle_), BusState::kUp);
  Refill(1);  // a steering alone is no pair
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
      [&calls](const can::Frame&) { return ++calls == 1 ? SendStatus::kQueueFull : SendStatus::kSent; });
  transmitter.Send(cycle_);
  EXPECT_EQ(calls, 1);  // no acceleration without its steering
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
  EXPECT_EQ(sent_, (std::vector<std::uint32_t>{1, 2}));
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
