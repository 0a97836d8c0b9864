#include "tools/falsify/cross_entropy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tools {
namespace {

constexpr double kSmoothing = 0.7;
constexpr double kLeastDeviation = 0.02;
constexpr double kOfUniform = 0.28867513459481287;  // standard deviation, 1/sqrt(12)

}  // namespace

double CrossEntropy::Normal() {  // Box and Muller
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random_.Uniform(0.0, 1.0)));
  return radius * std::cos(2.0 * std::numbers::pi * random_.Uniform(0.0, 1.0));
}

CrossEntropy::Point CrossEntropy::Draw() {
  Point point;
  point.reserve(coordinates_.size());
  for (const Coordinate& coordinate : coordinates_) {
    double value = random_.Uniform(0.0, 1.0);
    if (coordinate.deviation > 0.0) {
      do {
        value = coordinate.mean + coordinate.deviation * Normal();
      } while (value < 0.0 || value >= 1.0);
    }
    point.push_back(value);
  }
  return point;
}

void CrossEntropy::Learn(std::span<const Point> elite) {
  if (elite.size() < 2) return;
  const auto count = static_cast<double>(elite.size());
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    double mean = 0.0, variance = 0.0;
    for (const Point& point : elite) mean += point[i] / count;
    for (const Point& point : elite) variance += (point[i] - mean) * (point[i] - mean) / (count - 1.0);
    Coordinate& own = coordinates_[i];
    const double before = own.deviation > 0.0 ? own.deviation : kOfUniform;
    own.mean = std::lerp(own.mean, mean, kSmoothing);
    own.deviation = std::max(kLeastDeviation, std::lerp(before, std::sqrt(variance), kSmoothing));
  }
}

}  // namespace tools
