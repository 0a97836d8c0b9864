#include "base/percentile.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace base {
namespace {

TEST(Percentile, IsTheValueOfTheNearestRank) {
  std::vector<int> values;
  for (int i = 1; i <= 100; ++i) values.push_back(i);
  EXPECT_EQ(Percentile(values, 0.5), 50);
  EXPECT_EQ(Percentile(values, 0.07), 7);
  EXPECT_EQ(Percentile(values, 0.99), 99);
  EXPECT_EQ(Percentile(values, 1.0), 100);
  values.push_back(101);
  EXPECT_EQ(Percentile(values, 0.5), 51);
  EXPECT_EQ(Percentile(values, 0.99), 100);
  EXPECT_EQ(Percentile(std::vector<double>{3.5}, 0.0), 3.5);
  EXPECT_EQ(Percentile(std::vector<double>{}, 0.5), 0.0);
}

}  // namespace
}  // namespace base
