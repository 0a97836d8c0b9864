// Measured times of one kind [µs] and their statistics.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/percentile.hpp"

namespace tools {

class Times {
 public:
  template <typename Work>
  void Measure(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    all_.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
  }

  // Takes a time that was measured elsewhere [µs].
  void Add(double time) { all_.push_back(time); }
  void Add(const Times& others) { all_.insert(all_.end(), others.all_.begin(), others.all_.end()); }

  [[nodiscard]] std::size_t count() const { return all_.size(); }
  [[nodiscard]] double Median() const { return At(0.5); }
  [[nodiscard]] double P99() const { return At(0.99); }
  [[nodiscard]] double Max() const { return At(1.0); }
  [[nodiscard]] nlohmann::ordered_json ToJson() const {
    return {{"median_us", Median()}, {"p99_us", P99()}, {"max_us", Max()}};
  }

 private:
  [[nodiscard]] double At(double share) const {
    std::vector<double> sorted = all_;
    std::ranges::sort(sorted);
    return base::Percentile(sorted, share);
  }

  std::vector<double> all_;
};

}  // namespace tools
