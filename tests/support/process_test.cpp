#include "tests/support/process.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <stdexcept>

namespace test_support {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Process, OutputAndStatusAreKeptApart) {
  const Outcome outcome =
      test_support::Run({"sh", "-c", "printf '%s' \"$1\"; printf error >&2; exit 3", "sh", "two words\n"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.out, "two words\n");
  EXPECT_EQ(outcome.err, "error");
}

TEST(Process, SignalEndsItWithItsNumber) {
  Process process({"sleep", "60"});
  EXPECT_FALSE(process.Wait(milliseconds(20)));
  EXPECT_TRUE(process.Running());
  process.Signal(SIGTERM);
  EXPECT_EQ(process.Wait(seconds(10)), 128 + SIGTERM);
  EXPECT_EQ(process.Wait(seconds(0)), 128 + SIGTERM) << "the status is kept";
}

TEST(Process, IsKilledAtTheEndOfItsScope) {
  pid_t pid = 0;
  {
    const Process process({"sleep", "60"});
    pid = process.pid();
    ASSERT_EQ(::kill(pid, 0), 0);
  }
  EXPECT_NE(::kill(pid, 0), 0);
}

TEST(Process, ACommandThatCannotStartThrows) {
  EXPECT_THROW(Process({"/no/such/command"}), std::runtime_error);
  EXPECT_THROW(test_support::Run({"sleep", "60"}, milliseconds(20)), std::runtime_error);
}

TEST(TempDir, IsRemovedWithItsContents) {
  std::filesystem::path path;
  {
    const TempDir folder;
    path = folder.path();
    std::filesystem::create_directories(folder / "a/b");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace test_support
