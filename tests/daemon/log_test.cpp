#include "daemon/log.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lpvmpcd {
namespace {

TEST(Log, JournalIsRecognisedByDeviceAndInode) {
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  struct stat status {};
  ASSERT_EQ(::fstat(pipe[1], &status), 0);
  const std::string stream = fmt::format("{}:{}", status.st_dev, status.st_ino);
  EXPECT_TRUE(IsJournal(pipe[1], stream));
  EXPECT_FALSE(
      IsJournal(pipe[1], stream + "0"));  // inherited from a service, but stderr has been redirected since
  EXPECT_FALSE(IsJournal(pipe[1], ""));
  ::close(pipe[0]);
  ::close(pipe[1]);
  EXPECT_FALSE(IsJournal(pipe[1], stream));
}

}  // namespace
}  // namespace lpvmpcd
