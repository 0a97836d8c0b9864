// Histogram of durations with 32 buckets per power of two. The number of buckets is fixed: adding a duration takes
// constant time, and memory does not grow over years.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/time.hpp"

namespace base {

class LatencyHistogram {
 public:
  // Percentiles are over-reported by at most this fraction, the width of a bucket, never under-reported.
  static constexpr double kRelativeError = 1.0 / 32;
  // The error bound holds up to this time; longer times are counted as this one.
  static constexpr Time kLongest{(std::int64_t{1} << 37) - 1};  // 137 s

  // A negative time counts as 0.
  void Add(Time time);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] Time max() const { return max_; }  // exact; 0 before the first
  // Nearest rank: the shortest time exceeded by at most a fraction 1 − `share`, 0..1, of all times. 0 before the first.
  [[nodiscard]] Time Percentile(double share) const;

 private:
  static constexpr std::size_t kBuckets = 33UL * 32;

  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t count_ = 0;
  Time max_{};
};

// Latencies of the daemon.
struct Latencies {
  LatencyHistogram cycle;  // cycles started by a state: arrival of its last frame to both commands sent
  LatencyHistogram step;   // control steps that solved a problem, whether the plan was accepted or not
};

}  // namespace base
