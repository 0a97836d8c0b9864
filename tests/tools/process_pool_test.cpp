#include "tools/io/process_pool.hpp"

#include <csignal>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>
#include <stdexcept>
#include <unistd.h>

namespace {

using testing::HasSubstr;
using tools::MapInProcesses;

std::string ErrorOf(const std::function<std::string(std::size_t)>& work) {
  try {
    (void)MapInProcesses(8, 2, work);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(MapInProcesses, ResultsStandInTheOrderOfTheItemsWhateverTheJobs) {
  for (const int jobs : {1, 2, 7}) {
    int done = 0;
    const auto results = MapInProcesses(
        20, jobs,
        [](std::size_t i) {
          usleep(i % 3 == 0 ? 20'000 : 0);  // later items overtake
          return std::string(i * 1000, 'x') + std::to_string(i);
        },
        [&] { ++done; });
    ASSERT_EQ(results.size(), 20u);
    for (std::size_t i = 0; i < results.size(); ++i) {
      EXPECT_EQ(results[i], std::string(i * 1000, 'x') + std::to_string(i));
    }
    EXPECT_EQ(done, 20);
  }
}

TEST(MapInProcesses, EachItemHasAProcessOfItsOwn) {
  const auto pids = MapInProcesses(6, 2, [](std::size_t) { return std::to_string(getpid()); });
  EXPECT_EQ(std::set<std::string>(pids.begin(), pids.end()).size(), 6u);
  EXPECT_EQ(std::count(pids.begin(), pids.end(), std::to_string(getpid())), 0);
}

TEST(MapInProcesses, ResultLargerThanAPipeComesWhole) {
  const auto results =
      MapInProcesses(2, 2, [](std::size_t i) { return std::string(1'000'000, i == 0 ? 'a' : 'b'); });
  EXPECT_EQ(results[0], std::string(1'000'000, 'a'));
  EXPECT_EQ(results[1], std::string(1'000'000, 'b'));
}

TEST(MapInProcesses, FailureIsReportedWithItsItem) {
  EXPECT_THAT(ErrorOf([](std::size_t i) -> std::string {
                if (i == 3) throw std::runtime_error("out of luck");
                return "";
              }),
              AllOf(HasSubstr("item 3"), HasSubstr("out of luck")));
}

TEST(MapInProcesses, CrashIsReportedWithItsSignal) {
  EXPECT_THAT(ErrorOf([](std::size_t i) {
                if (i == 5) raise(SIGKILL);
                return std::string();
              }),
              AllOf(HasSubstr("item 5"), HasSubstr("signal 9")));
}

}  // namespace
