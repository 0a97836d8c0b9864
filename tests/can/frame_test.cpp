#include "can/frame.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>

namespace can {
namespace {

TEST(Frame, StandardAndExtendedIdsHaveTheirLimits) {
  EXPECT_TRUE(IsValid({.id = 0x7FF}));
  EXPECT_FALSE(IsValid({.id = 0x800}));
  EXPECT_TRUE(IsValid({.id = 0x1FFFFFFF, .extended = true}));
  EXPECT_FALSE(IsValid({.id = 0x20000000, .extended = true}));
  EXPECT_TRUE(IsValid({.id = CAN_ERR_MASK, .kind = FrameKind::kError}));
}

TEST(Frame, ClassicPayloadHasAtMostEightBytes) {
  EXPECT_TRUE(IsValid({.length = 8}));
  EXPECT_FALSE(IsValid({.length = 9}));
  EXPECT_FALSE(IsValid({.kind = FrameKind::kRemote, .length = 9}));
}

TEST(Frame, FdPayloadHasOneOfSixteenLengths) {
  int valid = 0;
  for (int length = 0; length < 256; ++length) {
    valid += IsValid({.fd = true, .length = static_cast<std::uint8_t>(length)}) ? 1 : 0;
  }
  EXPECT_EQ(valid, 16);
  EXPECT_TRUE(IsValid({.fd = true, .length = 64}));
  EXPECT_FALSE(IsValid({.fd = true, .length = 63}));
}

TEST(Frame, RemoteAndErrorFramesAreNeverFd) {
  EXPECT_FALSE(IsValid({.kind = FrameKind::kRemote, .fd = true}));
  EXPECT_FALSE(IsValid({.kind = FrameKind::kError, .fd = true}));
}

TEST(Frame, RemoteFrameHasNoPayload) {
  EXPECT_TRUE((Frame{.kind = FrameKind::kRemote, .length = 4}).Payload().empty());
}

TEST(Frame, TimeAndBytesBehindTheLengthDoNotShowOnTheWire) {
  Frame a{.id = 1, .length = 1};
  Frame b = a;
  b.timestamp = Time(std::chrono::nanoseconds(5));
  b.data[1] = std::byte{7};
  EXPECT_TRUE(SameOnWire(a, b));
  b.data[0] = std::byte{7};
  EXPECT_FALSE(SameOnWire(a, b));
}

}  // namespace
}  // namespace can
