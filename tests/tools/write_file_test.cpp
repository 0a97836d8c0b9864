#include "tools/io/write_file.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/process.hpp"
#include "tests/support/temp_dir.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string Read(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(WriteFile, ReplacesTheWholeFileAndLeavesNothingBeside) {
  const test_support::TempDir folder;
  const auto file = folder.path() / "f";
  tools::WriteFile(file, "a longer text");
  tools::WriteFile(file, "short");
  EXPECT_EQ(Read(file), "short");
  const std::filesystem::directory_iterator entries(folder.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(WriteFile, FollowsALinkAndLeavesItOne) {
  const test_support::TempDir folder;
  tools::WriteFile(folder.path() / "f", "old");
  std::filesystem::create_symlink("f", folder.path() / "link");
  tools::WriteFile(folder.path() / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link"));
  EXPECT_EQ(Read(folder.path() / "f"), "new");
}

TEST(WriteFile, PipeIsWrittenToAndStaysAPipe) {
  const test_support::TempDir folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  test_support::Process reader({"cat", pipe.string()});
  tools::WriteFile(pipe, "through");
  EXPECT_EQ(reader.Wait(std::chrono::seconds(10)), 0);
  EXPECT_EQ(reader.Stdout(), "through");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(WriteFile, FileThatCannotBeWrittenIsNamedAndStaysAsItWas) {
  const test_support::TempDir folder;
  std::filesystem::create_directory(folder.path() / "f");
  for (const auto& file :
       {folder.path() / "f", folder.path() / "none" / "f", std::filesystem::path("/dev/full")}) {
    EXPECT_THAT([&] { tools::WriteFile(file, "text"); },
                testing::ThrowsMessage<std::runtime_error>(
                    AllOf(HasSubstr(file.string()), HasSubstr("cannot be written"))));
  }
  EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "f"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

}  // namespace
