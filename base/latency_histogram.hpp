// How often which time was taken: 32 buckets for each power of two, of fixed number, so that counting a time costs
// nothing and neither does waiting for years.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/time.hpp"

namespace base {

class LatencyHistogram {
 public:
  // By this share of itself, at most, a percentile is told too long, never too short: that of a bucket's width.
  static constexpr double kRelativeError = 1.0 / 32;
  // Up to it the error holds; longer times are counted as longer than this.
  static constexpr Time kLongest{(std::int64_t{1} << 37) - 1};  // 137 s

  // A time below zero counts as none.
  void Add(Time time);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] Time max() const { return max_; }  // exact; 0 before the first
  // Nearest rank: the shortest time that is not exceeded by more than 1 − `share`, 0..1, of all. 0 before the first.
  [[nodiscard]] Time Percentile(double share) const;

 private:
  static constexpr std::size_t kBuckets = 33UL * 32;

  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t count_ = 0;
  Time max_{};
};

// How quick the daemon is.
struct Latencies {
  LatencyHistogram cycle;  // of each state that was answered: arrival of its last frame to both commands sent
  LatencyHistogram step;   // of each control step that made a plan, accepted or not
};

}  // namespace base
