// Percentiles of figures that were measured.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace base {

// Nearest-rank percentile: the smallest value of `sorted` above which lie no more than 1 - `share`, 0..1, of them.
// T{} if there are none.
template <typename T>
[[nodiscard]] T Percentile(const std::vector<T>& sorted, double share) {
  if (sorted.empty()) return T{};
  // Less a whisker: 0.07 * 100 is a little more than 7.
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size()) - 1e-9));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace base
