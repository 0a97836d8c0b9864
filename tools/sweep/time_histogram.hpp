// Counts of measured times, in buckets that grow by 2 %: the measurements of many processes and machines can be added,
// and the histogram stays small.
#pragma once

#include <cstdint>
#include <map>

namespace tools {

class TimeHistogram {
 public:
  void Add(double seconds);  // times up to 1 ns, also zero and negative ones, count in bucket 0
  void Add(const TimeHistogram& other);
  void AddBucket(int bucket, std::int64_t count) { counts_[bucket] += count; }

  [[nodiscard]] const std::map<int, std::int64_t>& counts() const { return counts_; }
  // Nearest rank [s], over-reported by at most 2 % (times below 1 ns as 1 ns); 0 if the histogram is empty.
  [[nodiscard]] double Percentile(double share) const;

 private:
  std::map<int, std::int64_t> counts_;  // by bucket: times up to 1.02^bucket ns
};

}  // namespace tools
