#include "base/time.hpp"

#include <gtest/gtest.h>

namespace base {
namespace {

using namespace std::chrono_literals;

TEST(ArrivalTime, IsNowLessTheAgeByTheKernelsStamp) {
  EXPECT_EQ(ArrivalTime(100s, 3ms, 99s), 100s - 3ms);
  EXPECT_EQ(ArrivalTime(100s, 5s, 90s), 95s);
}

TEST(ArrivalTime, ClockThatWasSetMakesAFrameNeitherNewerThanNowNorOlderThanTheEmptyQueue) {
  EXPECT_EQ(ArrivalTime(100s, -3600s, 99s), 100s);
  EXPECT_EQ(ArrivalTime(100s, 3600s, 99950ms), 99950ms);
}

}  // namespace
}  // namespace base
