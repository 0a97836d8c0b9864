// How often which time was taken, in buckets each 2 % longer than the one before: what many processes and machines
// measured is added up, and stays small.
#pragma once

#include <cstdint>
#include <map>

namespace tools {

class TimeHistogram {
 public:
  void Add(double seconds);  // one that is not above 0 counts in the shortest bucket, of a nanosecond
  void Add(const TimeHistogram& other);
  void AddBucket(int bucket, std::int64_t count) { counts_[bucket] += count; }

  [[nodiscard]] const std::map<int, std::int64_t>& counts() const { return counts_; }
  // Nearest rank, told too long by at most 2 % [s]; 0 of none.
  [[nodiscard]] double Percentile(double share) const;

 private:
  std::map<int, std::int64_t> counts_;  // by bucket: times up to 1.02^bucket ns
};

}  // namespace tools
