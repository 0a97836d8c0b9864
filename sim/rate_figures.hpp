// RMS and 99th percentile of how fast a commanded value changes.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/percentile.hpp"

namespace sim {

class RateFigures {
 public:
  explicit RateFigures(double period) : period_(period) {}  // between two values [s]

  // The value of one cycle; none if nothing is commanded, after which the next value is the first of a new run.
  void Take(const std::optional<double>& value) {
    if (value && last_) magnitudes_.push_back(std::abs(*value - *last_) / period_);
    last_ = value;
  }

  // None without two consecutive values.
  [[nodiscard]] std::optional<double> Rms() const {
    if (magnitudes_.empty()) return std::nullopt;
    double squared = 0.0;
    for (const double rate : magnitudes_) squared += rate * rate;
    return std::sqrt(squared / static_cast<double>(magnitudes_.size()));
  }
  [[nodiscard]] std::optional<double> P99() const {
    if (magnitudes_.empty()) return std::nullopt;
    std::vector<double> sorted = magnitudes_;
    std::ranges::sort(sorted);
    return base::Percentile(sorted, 0.99);
  }

 private:
  double period_;
  std::optional<double> last_;
  std::vector<double> magnitudes_;
};

}  // namespace sim
