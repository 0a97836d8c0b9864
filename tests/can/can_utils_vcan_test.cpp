// Log lines are compatible with can-utils in both directions.
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <signal.h>
#include <sstream>

#include "can/candump_log.hpp"
#include "can/socket.hpp"
#include "tests/can/bus.hpp"
#include "tests/support/temp_dir.hpp"

namespace can {
namespace {

using std::chrono::seconds;
using test_support::Process;
using test_support::TempDir;
using test_support::WaitUntil;

std::vector<Frame> OneOfEachKind() {
  std::vector<Frame> frames{MakeFrame(0x123, {0, 1, 2, 3, 4, 5, 6, 0xFF}), MakeFrame(0x7FF)};
  frames.push_back(MakeFrame(0x123, {1}));
  frames.back().extended = true;
  frames.push_back({.id = 0x321, .kind = FrameKind::kRemote});
  frames.push_back({.id = 0x321, .kind = FrameKind::kRemote, .length = 5});
  frames.push_back(MakeFrame(CAN_ERR_BUSOFF, {0, 0, 0, 0, 0, 0, 0, 0}));
  frames.back().kind = FrameKind::kError;
  frames.push_back({.id = 0x55, .fd = true, .fd_flags = CANFD_BRS | CANFD_ESI, .length = 64});
  frames.back().data.fill(std::byte{0xA5});
  return frames;
}

TEST(CanUtils, CandumpsTextOfOurFramesIsReadAsTheSameFrames) {
  const std::vector<Frame> frames = OneOfEachKind();
  Socket sender("vcan0", {.receive_own = true, .fd_frames = true});
  Process candump({"stdbuf", "-oL", "candump", "-L", "vcan0,0:0,#FFFFFFFF"});
  // candump does not report when it starts to listen, so a frame with a spare id is sent until it shows up.
  ASSERT_TRUE(WaitUntil([&] {
    EXPECT_EQ(sender.Send(MakeFrame(0x001)), SendStatus::kSent);
    return !candump.Stdout().empty();
  }));
  for (const Frame& frame : frames) ASSERT_EQ(sender.Send(frame), SendStatus::kSent);
  EXPECT_TRUE(WaitUntil([&] { return candump.Stdout().find("055##") != std::string::npos; }));
  candump.Signal(SIGINT);
  ASSERT_TRUE(candump.Wait(seconds(10)));

  std::vector<LogEntry> entries;
  std::istringstream text(candump.Stdout());
  for (std::string line; std::getline(text, line);) {
    const auto result = ParseCandumpLine(line);
    ASSERT_TRUE(result) << line << ": " << result.error();
    ASSERT_TRUE(result->has_value()) << line;
    EXPECT_EQ((*result)->interface, "vcan0");
    // Newer kernels set CANFD_FDF among the flags of an FD frame; Frame does not hold it.
    if (!(*result)->frame.fd) {
      EXPECT_EQ(FormatCandumpLine((*result)->frame, "vcan0"), line) << "we write what candump writes";
    }
    if ((*result)->frame.id != 0x001) entries.push_back(**result);
  }
  ASSERT_EQ(entries.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_TRUE(SameOnWire(entries[i].frame, frames[i])) << FormatCandumpLine(frames[i], "vcan0");
  }
}

TEST(CanUtils, CanplayerPlaysOurLog) {
  const std::vector<Frame> frames = OneOfEachKind();
  const TempDir folder;
  {
    std::ofstream log(folder / "candump.log");
    Time time(seconds(1'700'000'000));
    for (Frame frame : frames) {
      frame.timestamp = time;
      time += std::chrono::milliseconds(1);
      log << FormatCandumpLine(frame, "vcan0") << '\n';
    }
  }
  Socket receiver("vcan1", {.error_mask = CAN_ERR_MASK, .fd_frames = true});
  const auto outcome = test_support::Run({"canplayer", "-I", folder / "candump.log", "vcan1=vcan0"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<Received> all = Drain(receiver);
  ASSERT_EQ(all.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_TRUE(SameOnWire(all[i].frame, frames[i])) << FormatCandumpLine(frames[i], "vcan0");
  }
}

}  // namespace
}  // namespace can
