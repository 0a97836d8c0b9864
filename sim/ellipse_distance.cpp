#include "sim/ellipse_distance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sim {
namespace {

// Distance to the edge in the first quadrant, a >= b. The nearest point (x, y) has x = a² p / (t + a²),
// y = b² q / (t + b²) for the greatest root t of (a p / (t + a²))² + (b q / (t + b²))² = 1; the code uses s = t / b².
double DistanceInQuadrant(double a, double b, double p, double q) {
  if (q == 0.0) {
    const double focal = a * a - b * b;
    if (a * p >= focal) return std::abs(p - a);
    const double cosine = a * p / focal;
    return std::hypot(a * cosine - p, b * std::sqrt(1.0 - cosine * cosine));
  }
  if (p == 0.0) return std::abs(q - b);
  const double ratio = (a / b) * (a / b);
  const double u = p / a;
  const double v = q / b;
  double low = v - 1.0;
  double high = std::max(0.0, std::hypot(ratio * u, v) - 1.0);
  double s = 0.5 * (low + high);
  while (low < s && s < high) {
    const double along = ratio * u / (s + ratio);
    const double across = v / (s + 1.0);
    (along * along + across * across > 1.0 ? low : high) = s;
    s = 0.5 * (low + high);
  }
  return std::hypot(ratio * p / (s + ratio) - p, q / (s + 1.0) - q);
}

}  // namespace

double EllipseDistance(const control::Obstacle& obstacle, double X, double Y) {
  const double cosine = std::cos(obstacle.heading);
  const double sine = std::sin(obstacle.heading);
  double p = std::abs(cosine * (X - obstacle.X) + sine * (Y - obstacle.Y));
  double q = std::abs(cosine * (Y - obstacle.Y) - sine * (X - obstacle.X));
  double a = obstacle.r_x;
  double b = obstacle.r_y;
  if (a < b) {
    std::swap(a, b);
    std::swap(p, q);
  }
  const double distance = DistanceInQuadrant(a, b, p, q);
  return std::hypot(p / a, q / b) < 1.0 ? -distance : distance;
}

}  // namespace sim
