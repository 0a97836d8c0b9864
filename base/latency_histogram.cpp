#include "base/latency_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace base {
namespace {

// Each value below 64 has its own bucket. Larger values share one if their six leading bits and their length agree.
constexpr int kLeadingBits = 6;
constexpr std::uint64_t kPerPowerOfTwo = 1U << (kLeadingBits - 1);

std::size_t BucketOf(std::uint64_t value) {
  const int following = std::max(0, static_cast<int>(std::bit_width(value)) - kLeadingBits);
  return static_cast<std::size_t>(following) * kPerPowerOfTwo + (value >> following);
}

std::uint64_t LargestIn(std::size_t bucket) {
  if (bucket < 2 * kPerPowerOfTwo) {
    return bucket;
  }
  const std::size_t following = bucket / kPerPowerOfTwo - 1;
  return ((bucket - following * kPerPowerOfTwo + 1) << following) - 1;
}

}  // namespace

void LatencyHistogram::Add(Time time) {
  time = std::max(time, Time{0});
  ++counts_[BucketOf(static_cast<std::uint64_t>(std::min(time, kLongest).count()))];
  ++count_;
  max_ = std::max(max_, time);
}

Time LatencyHistogram::Percentile(double share) const {
  const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t passed = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    passed += counts_[bucket];
    if (counts_[bucket] != 0 && passed >= rank) {
      return std::min(Time(static_cast<std::int64_t>(LargestIn(bucket))), max_);
    }
  }
  return max_;
}

}  // namespace base
