#include "base/latency_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "tests/support/allocations.hpp"

namespace base {
namespace {

using namespace std::chrono_literals;

TEST(LatencyHistogram, EmptyTellsNothing) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0U);
  EXPECT_EQ(histogram.max(), 0ns);
  EXPECT_EQ(histogram.Percentile(0.99), 0ns);
}

TEST(LatencyHistogram, PercentilesAreWithinTheStatedErrorAboveThoseOfTheSortedTimes) {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> distribution(12.0, 4.0);  // from a few ns to minutes
  LatencyHistogram histogram;
  std::vector<Time> times;
  for (int i = 0; i < 20000; ++i) {
    times.push_back(std::min(Time(std::llround(distribution(random))), LatencyHistogram::kLongest));
    histogram.Add(times.back());
  }
  std::ranges::sort(times);
  EXPECT_EQ(histogram.count(), times.size());
  EXPECT_EQ(histogram.max(), times.back());
  for (int rank = 1; rank <= 20000; rank += 37) {
    const Time exact = times[static_cast<std::size_t>(rank - 1)];
    const Time reported = histogram.Percentile(rank / 20000.0 - 1e-9);
    EXPECT_GE(reported, exact);
    EXPECT_LE(ToSeconds(reported), ToSeconds(exact) * (1.0 + LatencyHistogram::kRelativeError)) << rank;
  }
}

TEST(LatencyHistogram, ShortTimesAreExact) {
  for (int ns = 0; ns < 64; ++ns) {
    LatencyHistogram histogram;
    histogram.Add(Time(ns));
    histogram.Add(1s);
    EXPECT_EQ(histogram.Percentile(0.5), Time(ns));
  }
}

TEST(LatencyHistogram, TimesOutOfRangeAreCountedAtItsEnds) {
  LatencyHistogram histogram;
  histogram.Add(-5ns);
  EXPECT_EQ(histogram.Percentile(1.0), 0ns);
  histogram.Add(1h);
  histogram.Add(2h);
  EXPECT_EQ(histogram.max(), 2h);
  EXPECT_GE(histogram.Percentile(0.5), LatencyHistogram::kLongest);
}

TEST(LatencyHistogram, TakesNothingFromTheHeap) {
  const std::size_t before = test_support::Allocations();
  LatencyHistogram histogram;
  for (int i = 0; i < 1000; ++i) histogram.Add(i * 1ms);
  EXPECT_GT(histogram.Percentile(0.99), 0s);
  EXPECT_EQ(test_support::Allocations(), before);
}

}  // namespace
}  // namespace base
