// The curves of which a Route is made, by arc length: linear curvature, and cubic splines.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "control/road/route.hpp"
#include "control/vehicle/types.hpp"

namespace control::detail {

// Eight-point Gauss-Legendre rule on [-1, 1] (Abramowitz and Stegun, table 25.4); exact to order 15.
inline constexpr std::array<double, 4> kNodes{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                              0.9602898564975363};
inline constexpr std::array<double, 4> kWeights{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                                0.1012285362903763};

// Integral of f from 0 to `to`.
template <typename F>
auto Integrate(double to, const F& f) {
  const double half = 0.5 * to;
  using Value = std::decay_t<decltype(f(to))>;
  const auto pair = [&](std::size_t i) -> Value {
    return kWeights[i] * (f(half * (1.0 - kNodes[i])) + f(half * (1.0 + kNodes[i])));
  };
  return Value(half * (pair(0) + pair(1) + pair(2) + pair(3)));
}

// Curvature linear in arc length; its heading changes by less than kLargestTurn, so one quadrature is exact.
inline constexpr double kLargestTurn = 0.5;
struct LinearCurvature {
  double curvature;
  double slope;

  RoutePoint At(const RoutePoint& start, double s) const {
    const auto heading = [&](double l) { return start.psi + l * (curvature + 0.5 * slope * l); };
    const Eigen::Vector2d moved =
        Integrate(s, [&](double l) { return Eigen::Vector2d(std::cos(heading(l)), std::sin(heading(l))); });
    return {start.X + moved.x(), start.Y + moved.y(), heading(s), curvature + slope * s, 0.0};
  }
};

// Cubic x(t), y(t), t in [0, t_end].
struct Cubic {
  std::array<Eigen::Vector2d, 4> c;
  double t_end;
  double length;

  Eigen::Vector2d Velocity(double t) const { return c[1] + t * (2.0 * c[2] + 3.0 * t * c[3]); }
  double ArcLength(double t) const {
    return Integrate(t, [this](double tau) { return Velocity(tau).norm(); });
  }
  double ParameterAt(double s) const {
    double t = t_end * s / length;
    for (int i = 0; i < 20; ++i) {
      const double step = (s - ArcLength(t)) / std::max(Velocity(t).norm(), 1e-6);
      t = std::clamp(t + step, 0.0, t_end);
      if (std::abs(step) < 1e-13 * t_end) break;
    }
    return t;
  }
  RoutePoint At(const RoutePoint& start, double s) const {
    const double t = ParameterAt(s);
    const Eigen::Vector2d p = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
    const Eigen::Vector2d v = Velocity(t);
    const Eigen::Vector2d a = 2.0 * c[2] + 6.0 * t * c[3];
    const double curvature = (v.x() * a.y() - v.y() * a.x()) / std::pow(v.squaredNorm(), 1.5);
    return {p.x(), p.y(), start.psi + WrapAngle(std::atan2(v.y(), v.x()) - start.psi), curvature, 0.0};
  }
};

// Second derivatives of the natural cubic spline at its knots (tridiagonal system, Thomas algorithm).
inline std::vector<Eigen::Vector2d> SplineCurvature(std::span<const Eigen::Vector2d> p,
                                                    std::span<const double> h) {
  const std::size_t n = p.size();
  std::vector<Eigen::Vector2d> second(n, Eigen::Vector2d::Zero());
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double pivot = 2.0 * (h[i - 1] + h[i]) - h[i - 1] * upper[i - 1];
    upper[i] = h[i] / pivot;
    const Eigen::Vector2d rhs = 6.0 * ((p[i + 1] - p[i]) / h[i] - (p[i] - p[i - 1]) / h[i - 1]);
    second[i] = (rhs - h[i - 1] * second[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) second[i] -= upper[i] * second[i + 1];
  return second;
}

}  // namespace control::detail
