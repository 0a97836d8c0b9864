// Frames through the kernel's vcan0.
#include <cstdlib>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <new>
#include <utility>

#include "can/socket.hpp"
#include "tests/can/bus.hpp"
#include "tests/support/allocations.hpp"

namespace can {
namespace {

TEST(SocketOnVcan, SendAndReceiveDoNotAllocate) {
  Socket socket("vcan0", {.receive_own = true});
  Received received;
  const std::size_t before = test_support::Allocations();
  const SendStatus sent = socket.Send(MakeFrame(0x10, {1, 2}));
  const ReceiveStatus first = socket.Receive(received);
  const ReceiveStatus second = socket.Receive(received);
  EXPECT_EQ(test_support::Allocations(), before);
  EXPECT_EQ(sent, SendStatus::kSent);
  EXPECT_EQ(first, ReceiveStatus::kFrame);
  EXPECT_EQ(second, ReceiveStatus::kWouldBlock);
}

TEST(SocketOnVcan, FramesOfEveryKindArriveAsSent) {
  Socket sender("vcan0", {.fd_frames = true});
  Socket receiver("vcan0", {.error_mask = CAN_ERR_MASK, .fd_frames = true});
  std::vector<Frame> frames{MakeFrame(0x7FF, {1, 2, 3, 4, 5, 6, 7, 8}), MakeFrame(0)};
  frames.push_back(MakeFrame(0x1FFFFFFF, {0xFF}));
  frames.back().extended = true;
  frames.push_back({.id = 0x123, .kind = FrameKind::kRemote, .length = 4});
  frames.push_back(MakeFrame(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_OVERFLOW, 0, 0, 0, 0, 0, 0}));
  frames.back().kind = FrameKind::kError;
  frames.push_back({.id = 0x55, .fd = true, .fd_flags = CANFD_BRS, .length = 64});
  for (std::size_t i = 0; i < 64; ++i) frames.back().data[i] = static_cast<std::byte>(3 * i);
  frames.push_back({.id = 0x66, .fd = true, .length = 12});

  for (const Frame& frame : frames) ASSERT_EQ(sender.Send(frame), SendStatus::kSent);
  for (const Frame& frame : frames) {
    Received received;
    ASSERT_EQ(ReceiveSoon(receiver, received), ReceiveStatus::kFrame);
    EXPECT_TRUE(SameOnWire(received.frame, frame)) << std::hex << frame.id;
    EXPECT_FALSE(received.own);
  }
  Received received;
  EXPECT_EQ(receiver.Receive(received), ReceiveStatus::kWouldBlock);
}

TEST(SocketOnVcan, TimeStampsAreThoseOfTheKernelsClockAndNeverFall) {
  Socket sender("vcan0");
  Socket receiver("vcan0");
  const Time before = std::chrono::system_clock::now();
  for (int i = 0; i < 100; ++i) ASSERT_EQ(sender.Send(MakeFrame(0x100)), SendStatus::kSent);
  const Time after = std::chrono::system_clock::now();
  const std::vector<Received> all = Drain(receiver);
  ASSERT_EQ(all.size(), 100U);
  Time last = before;
  for (const Received& received : all) {
    EXPECT_GE(received.frame.timestamp, last);
    last = received.frame.timestamp;
  }
  EXPECT_LE(last, after);
}

TEST(SocketOnVcan, FiltersAreExact) {
  Socket sender("vcan0");
  Socket receiver("vcan0", {.filters = {ExactStandardId(0x123), ExactExtendedId(0x456)}});
  Frame extended = MakeFrame(0x123);
  extended.extended = true;
  Frame wanted_extended = MakeFrame(0x456);
  wanted_extended.extended = true;
  const Frame remote{.id = 0x123, .kind = FrameKind::kRemote};
  for (const Frame& frame :
       {MakeFrame(0x122), extended, remote, MakeFrame(0x123), MakeFrame(0x456), wanted_extended}) {
    ASSERT_EQ(sender.Send(frame), SendStatus::kSent);
  }
  const std::vector<Received> all = Drain(receiver);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_TRUE(SameOnWire(all[0].frame, MakeFrame(0x123)));
  EXPECT_TRUE(SameOnWire(all[1].frame, wanted_extended));
}

TEST(SocketOnVcan, ErrorFramesComeOnlyWhereAskedFor) {
  Socket sender("vcan0");
  Socket without("vcan0");
  Socket bus_off_only("vcan0", {.filters = {ExactStandardId(0x7FF)}, .error_mask = CAN_ERR_BUSOFF});
  for (const std::uint32_t error : {CAN_ERR_CRTL, CAN_ERR_BUSOFF}) {
    Frame frame = MakeFrame(error, {0, 0, 0, 0, 0, 0, 0, 0});
    frame.kind = FrameKind::kError;
    ASSERT_EQ(sender.Send(frame), SendStatus::kSent);
  }
  EXPECT_TRUE(Drain(without).empty());
  const std::vector<Received> all = Drain(bus_off_only);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].frame.kind, FrameKind::kError);
  EXPECT_EQ(all[0].frame.id, std::uint32_t{CAN_ERR_BUSOFF});
}

TEST(SocketOnVcan, OwnFramesAreReceivedOnlyWhereAskedForAndMarked) {
  Socket with("vcan0", {.receive_own = true});
  Socket without("vcan0");
  ASSERT_EQ(with.Send(MakeFrame(1)), SendStatus::kSent);
  ASSERT_EQ(without.Send(MakeFrame(2)), SendStatus::kSent);
  const std::vector<Received> all = Drain(with);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_TRUE(all[0].own);
  EXPECT_FALSE(all[1].own);
  const std::vector<Received> foreign = Drain(without);
  ASSERT_EQ(foreign.size(), 1U);
  EXPECT_EQ(foreign[0].frame.id, 1U);
  EXPECT_FALSE(foreign[0].own);
}

TEST(SocketOnVcan, FramesLostInAFullReceiveBufferAreCounted) {
  Socket sender("vcan0");
  Socket receiver("vcan0", {.receive_buffer_bytes = 1});
  EXPECT_GT(receiver.receive_buffer_bytes(), 1) << "the kernel has a least size";
  constexpr std::size_t kSent = 5000;
  for (std::size_t i = 0; i < kSent; ++i) ASSERT_EQ(sender.Send(MakeFrame(0x10)), SendStatus::kSent);
  const std::size_t received = Drain(receiver).size();
  EXPECT_LT(received, kSent);
  // The next frame brings the kernel's count.
  ASSERT_EQ(sender.Send(MakeFrame(0x11)), SendStatus::kSent);
  ASSERT_EQ(Drain(receiver).size(), 1U);
  EXPECT_EQ(received + receiver.dropped(), kSent);
}

TEST(SocketOnVcan, TheReceiveBufferAskedForHoldsABurst) {
  Socket sender("vcan0");
  Socket receiver("vcan0");
  for (int i = 0; i < 200; ++i) ASSERT_EQ(sender.Send(MakeFrame(0x10)), SendStatus::kSent);
  EXPECT_EQ(Drain(receiver).size(), 200U);
  EXPECT_EQ(receiver.dropped(), 0U);
}

TEST(SocketOnVcan, InvalidFramesAreNotSent) {
  Socket classic("vcan0");
  Socket fd("vcan0", {.fd_frames = true});
  EXPECT_EQ(classic.Send(MakeFrame(0x800)), SendStatus::kInvalidFrame);
  EXPECT_EQ(classic.Send({.id = 1, .length = 9}), SendStatus::kInvalidFrame);
  EXPECT_EQ(fd.Send({.id = 1, .fd = true, .length = 63}), SendStatus::kInvalidFrame);
  EXPECT_EQ(classic.Send({.id = 1, .fd = true, .length = 8}), SendStatus::kInvalidFrame)
      << "a socket without FD";
}

TEST(SocketOnVcan, FdFramesDoNotReachASocketWithoutFd) {
  Socket sender("vcan0", {.fd_frames = true});
  Socket classic("vcan0");
  ASSERT_EQ(sender.Send({.id = 1, .fd = true, .length = 64}), SendStatus::kSent);
  ASSERT_EQ(sender.Send(MakeFrame(2)), SendStatus::kSent);
  const std::vector<Received> all = Drain(classic);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].frame.id, 2U);
}

TEST(SocketOnVcan, AMovedSocketStaysOpenAndTheOtherIsClosed) {
  Socket first("vcan0", {.receive_own = true});
  Socket second("vcan1");
  second = std::move(first);
  EXPECT_EQ(second.interface(), "vcan0");
  const Socket third = std::move(second);
  EXPECT_GE(third.fd(), 0);
  EXPECT_EQ(third.interface(), "vcan0");
}

}  // namespace
}  // namespace can
