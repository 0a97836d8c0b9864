#include "tools/sweep/time_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace tools {
namespace {

constexpr double kGrowth = 1.02;
constexpr double kShortest = 1e-9;  // [s]

}  // namespace

void TimeHistogram::Add(double seconds) {
  const double growths = std::log(std::max(seconds, kShortest) / kShortest) / std::log(kGrowth);
  ++counts_[static_cast<int>(std::ceil(growths))];
}

void TimeHistogram::Add(const TimeHistogram& other) {
  for (const auto& [bucket, count] : other.counts_) counts_[bucket] += count;
}

double TimeHistogram::Percentile(double share) const {
  std::int64_t all = 0;
  for (const auto& [bucket, count] : counts_) all += count;
  std::int64_t up_to = 0;
  for (const auto& [bucket, count] : counts_) {
    up_to += count;
    if (static_cast<double>(up_to) >= share * static_cast<double>(all))
      return kShortest * std::pow(kGrowth, bucket);
  }
  return 0.0;
}

}  // namespace tools
