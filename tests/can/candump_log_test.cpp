#include "can/candump_log.hpp"

#include <array>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <rapidcheck/gtest.h>

namespace can {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

Frame Parsed(std::string_view line) {
  const auto result = ParseCandumpLine(line);
  if (!result || !*result) {
    ADD_FAILURE() << line << ": " << (result ? "no entry" : result.error());
    return {};
  }
  return (*result)->frame;
}

std::string ErrorOf(std::string_view line) {
  const auto result = ParseCandumpLine(line);
  return result ? "accepted" : result.error();
}

TEST(CandumpLog, StandardFrame) {
  const auto result = ParseCandumpLine("(1700000000.123456) vcan0 123#11aB");
  ASSERT_TRUE(result && *result);
  EXPECT_EQ((*result)->interface, "vcan0");
  const Frame& frame = (*result)->frame;
  EXPECT_EQ(frame.timestamp, Time(std::chrono::seconds(1700000000) + std::chrono::microseconds(123456)));
  EXPECT_EQ(frame.id, 0x123U);
  EXPECT_FALSE(frame.extended);
  EXPECT_EQ(frame.kind, FrameKind::kData);
  ASSERT_EQ(frame.length, 2);
  EXPECT_EQ(frame.data[0], std::byte{0x11});
  EXPECT_EQ(frame.data[1], std::byte{0xAB});
}

TEST(CandumpLog, EightDigitsAreAnExtendedId) {
  const Frame frame = Parsed("(0000000001.000001) can0 00000123#");
  EXPECT_TRUE(frame.extended);
  EXPECT_EQ(frame.id, 0x123U);
  EXPECT_EQ(frame.length, 0);
}

TEST(CandumpLog, EightDigitsWithTheErrorFlagAreAnErrorFrame) {
  const Frame frame = Parsed("(1.000001) can0 20000004#0001000000000000");
  EXPECT_EQ(frame.kind, FrameKind::kError);
  EXPECT_FALSE(frame.extended);
  EXPECT_EQ(frame.id, std::uint32_t{CAN_ERR_CRTL});
  EXPECT_EQ(frame.length, 8);
}

TEST(CandumpLog, RemoteFrameWithAndWithoutLength) {
  EXPECT_EQ(Parsed("(1.000001) can0 123#R").kind, FrameKind::kRemote);
  EXPECT_EQ(Parsed("(1.000001) can0 123#R").length, 0);
  EXPECT_EQ(Parsed("(1.000001) can0 123#R8").kind, FrameKind::kRemote);
  EXPECT_EQ(Parsed("(1.000001) can0 123#R8").length, 8);
}

TEST(CandumpLog, FdFrameWithFlags) {
  const Frame frame = Parsed("(1.000001) can0 123##3" + std::string(128, 'A'));
  EXPECT_TRUE(frame.fd);
  EXPECT_EQ(frame.fd_flags, CANFD_BRS | CANFD_ESI);
  EXPECT_EQ(frame.length, 64);
  EXPECT_EQ(frame.data[63], std::byte{0xAA});
  EXPECT_EQ(Parsed("(1.000001) can0 123##0").length, 0);
}

TEST(CandumpLog, DirectionSuffixAndEndOfLineAreAccepted) {
  for (const char* end : {" T", " R", "\r", "  ", " T\r"}) {
    EXPECT_EQ(Parsed(std::string("(1.000001) can0 123#11") + end).length, 1) << end;
  }
}

TEST(CandumpLog, BlankLinesAndCommentsHoldNoEntry) {
  for (const char* line : {"", "  ", "\r", "# (1.000001) can0 123#11", "  # comment"}) {
    const auto result = ParseCandumpLine(line);
    ASSERT_TRUE(result) << line;
    EXPECT_FALSE(result->has_value()) << line;
  }
}

TEST(CandumpLog, ErrorsNameColumnAndReason) {
  EXPECT_THAT(ErrorOf("1.000001) can0 123#"), StartsWith("column 1: expected '('"));
  EXPECT_THAT(ErrorOf("(x.000001) can0 123#"), StartsWith("column 2: expected seconds"));
  EXPECT_THAT(ErrorOf("(99999999999.000001) can0 123#"), StartsWith("column 2: expected seconds"));
  EXPECT_THAT(ErrorOf("(1) can0 123#"), StartsWith("column 3: expected '.'"));
  EXPECT_THAT(ErrorOf("(1.00001) can0 123#"), StartsWith("column 4: expected six decimals"));
  EXPECT_THAT(ErrorOf("(1.0000010) can0 123#"), StartsWith("column 4: expected six decimals"));
  EXPECT_THAT(ErrorOf("(1.000001 can0 123#"), StartsWith("column 10: expected ')'"));
  EXPECT_THAT(ErrorOf("(1.000001)"), StartsWith("column 11: expected an interface"));
  EXPECT_THAT(ErrorOf("(1.000001) a_very_long_name 123#"), StartsWith("column 12: expected an interface"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 12#"), StartsWith("column 17: expected an id of three or eight"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 800#"), StartsWith("column 17: standard id above 7FF"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 40000000#"), StartsWith("column 17: extended id above 1FFFFFFF"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 1x3#"), StartsWith("column 17: expected an id"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123"), StartsWith("column 20: expected '#'"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123#1"), StartsWith("column 22: expected the second digit"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123#11223344556677889"), HasSubstr("second digit"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123#112233445566778899"),
              StartsWith("column 21: no classic frame has a payload of 9 bytes"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123##0112233445566778899"),
              StartsWith("column 23: no FD frame has a payload of 9 bytes"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123##0" + std::string(130, '0')), HasSubstr("more than 64 bytes"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123##"), StartsWith("column 22: expected one digit of FD flags"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123#R9"), StartsWith("column 22: length of a remote frame"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 20000001#R"), StartsWith("column 26: no remote frame"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 20000001##0"), StartsWith("column 26: no FD frame"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123#11 X"), StartsWith("column 24: unexpected text"));
  EXPECT_THAT(ErrorOf("(1.000001) can0 123#11T"), StartsWith("column 23: unexpected text"));
}

TEST(CandumpLog, LineIsWrittenAsCandumpWritesIt) {
  Frame frame{.id = 0x12, .length = 2, .timestamp = Time(std::chrono::nanoseconds(1'000'002'999))};
  frame.data[0] = std::byte{0xAB};
  EXPECT_EQ(FormatCandumpLine(frame, "vcan0"), "(0000000001.000002) vcan0 012#AB00");
}

Frame AnyFrame() {
  static constexpr std::array<std::uint8_t, 16> kFdLengths{0, 1,  2,  3,  4,  5,  6,  7,
                                                           8, 12, 16, 20, 24, 32, 48, 64};
  Frame frame;
  frame.kind = *rc::gen::element(FrameKind::kData, FrameKind::kRemote, FrameKind::kError);
  frame.extended = frame.kind != FrameKind::kError && *rc::gen::arbitrary<bool>();
  const bool id_is_29_bits = frame.extended || frame.kind == FrameKind::kError;
  frame.id = *rc::gen::inRange<std::uint32_t>(0, (id_is_29_bits ? kMaxExtendedId : kMaxStandardId) + 1);
  frame.fd = frame.kind == FrameKind::kData && *rc::gen::arbitrary<bool>();
  frame.fd_flags = frame.fd ? *rc::gen::inRange<std::uint8_t>(0, 4) : std::uint8_t{0};
  frame.length = frame.fd ? *rc::gen::elementOf(kFdLengths) : *rc::gen::inRange<std::uint8_t>(0, 9);
  if (frame.kind != FrameKind::kRemote) {
    for (std::size_t i = 0; i < frame.length; ++i) {
      frame.data[i] = static_cast<std::byte>(*rc::gen::arbitrary<std::uint8_t>());
    }
  }
  frame.timestamp =
      Time(std::chrono::microseconds(*rc::gen::inRange<std::int64_t>(0, 4'000'000'000'000'000)));
  return frame;
}

RC_GTEST_PROP(CandumpLog, WhatIsWrittenIsReadBack, ()) {
  const Frame frame = AnyFrame();
  const std::string line = FormatCandumpLine(frame, "vcan12");
  const auto result = ParseCandumpLine(line);
  RC_ASSERT(result.has_value());
  RC_ASSERT(result->has_value());
  RC_ASSERT((*result)->interface == "vcan12");
  RC_ASSERT(SameOnWire((*result)->frame, frame));
  RC_ASSERT((*result)->frame.timestamp == frame.timestamp);
  RC_ASSERT(FormatCandumpLine((*result)->frame, "vcan12") == line);
}

// A damaged line is rejected or read as a valid frame; a rejection names a column, at most one past the end.
RC_GTEST_PROP(CandumpLog, DamagedLinesAreReadSafely, ()) {
  std::string line = FormatCandumpLine(AnyFrame(), "vcan0");
  const auto position = *rc::gen::inRange<std::size_t>(0, line.size());
  if (*rc::gen::arbitrary<bool>()) {
    line.resize(position);
  } else {
    line[position] = *rc::gen::arbitrary<char>();
  }
  const auto result = ParseCandumpLine(line);
  if (result) {
    if (result->has_value()) RC_ASSERT(IsValid((*result)->frame));
  } else {
    RC_ASSERT(result.error().starts_with("column "));
    RC_ASSERT(std::stoul(result.error().substr(7)) <= line.size() + 1);
  }
}

}  // namespace
}  // namespace can
