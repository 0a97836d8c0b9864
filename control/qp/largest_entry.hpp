// Maxima of absolute values that do not lose a NaN.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace control::detail {

// largest = max(largest, |value|), where NaN counts as infinite.
inline void Raise(double& largest, double value) {
  if (!(std::abs(value) <= largest))
    largest = std::isnan(value) ? std::numeric_limits<double>::infinity() : std::abs(value);
}

// The largest absolute value among the entries of vectors; infinity if one of them is NaN.
template <int kSize>
class LargestEntry {
 public:
  void Add(const Eigen::Matrix<double, kSize, 1>& value) {
    largest_ = largest_.cwiseMax(value.cwiseAbs());
    zero_ += 0.0 * value;
  }
  [[nodiscard]] double Value() const {
    return zero_.sum() == 0.0 ? largest_.maxCoeff() : std::numeric_limits<double>::infinity();
  }

 private:
  Eigen::Matrix<double, kSize, 1> largest_ = Eigen::Matrix<double, kSize, 1>::Zero();
  Eigen::Matrix<double, kSize, 1> zero_ = Eigen::Matrix<double, kSize, 1>::Zero();
};

}  // namespace control::detail
