// Percentiles of measured values.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace base {

// Nearest-rank percentile: the smallest value of `sorted` exceeded by at most a fraction 1 - `share`, 0..1, of the
// values. T{} if `sorted` is empty.
template <typename T>
[[nodiscard]] T Percentile(const std::vector<T>& sorted, double share) {
  if (sorted.empty()) return T{};
  // The small margin absorbs rounding: 0.07 * 100 is a little more than 7.
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size()) - 1e-9));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace base
