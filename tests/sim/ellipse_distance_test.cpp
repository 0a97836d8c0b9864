#include "sim/ellipse_distance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gtest/gtest.h"

namespace sim {
namespace {

using control::Obstacle;

TEST(EllipseDistance, CircleIsDistanceLessRadius) {
  const Obstacle circle{.X = 1.0, .Y = 2.0, .r_x = 1.5, .r_y = 1.5};
  EXPECT_NEAR(EllipseDistance(circle, 4.0, 6.0), 3.5, 1e-12);
  EXPECT_NEAR(EllipseDistance(circle, 1.0, 2.0), -1.5, 1e-12);
  EXPECT_NEAR(EllipseDistance(circle, 1.6, 2.8), -0.5, 1e-12);
}

// A point at distance d along the outward normal has its nearest point at the normal's foot.
TEST(EllipseDistance, PointOnANormalHasItsLength) {
  for (const Obstacle& obstacle : {Obstacle{.X = 3.0, .Y = -1.0, .r_x = 2.0, .r_y = 0.5, .heading = 0.7},
                                   Obstacle{.X = 3.0, .Y = -1.0, .r_x = 0.8, .r_y = 1.1, .heading = -2.0}}) {
    for (double angle = 0.0; angle < 2.0 * std::numbers::pi; angle += 0.1) {
      for (const double d : {0.0, 0.3, 5.0, 500.0, -0.02}) {
        const double along = obstacle.r_x * std::cos(angle);
        const double across = obstacle.r_y * std::sin(angle);
        const double n_x = obstacle.r_y * std::cos(angle);
        const double n_y = obstacle.r_x * std::sin(angle);
        const double norm = std::hypot(n_x, n_y);
        const double x = along + d * n_x / norm;
        const double y = across + d * n_y / norm;
        const double c = std::cos(obstacle.heading);
        const double s = std::sin(obstacle.heading);
        EXPECT_NEAR(EllipseDistance(obstacle, obstacle.X + c * x - s * y, obstacle.Y + s * x + c * y), d,
                    1e-9);
      }
    }
  }
}

TEST(EllipseDistance, InsideIsTheNearestPointOfTheEdge) {
  const Obstacle obstacle{.r_x = 3.0, .r_y = 1.0};
  for (const double x : {0.0, 0.5, 2.0, 2.7, 2.9}) {
    for (const double y : {0.0, 0.1, 0.2}) {
      if (x * x / 9.0 + y * y >= 1.0) continue;
      double nearest = 1e9;
      for (int i = 0; i < 200000; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 200000;
        nearest = std::min(nearest, std::hypot(3.0 * std::cos(angle) - x, std::sin(angle) - y));
      }
      EXPECT_NEAR(EllipseDistance(obstacle, x, y), -nearest, 1e-7) << x << ' ' << y;
    }
  }
}

TEST(EllipseDistance, ThinEllipseIsNoTrouble) {
  const Obstacle thin{.r_x = 5.0, .r_y = 1e-3};
  EXPECT_NEAR(EllipseDistance(thin, 2.0, 3.0), 3.0, 1e-3);
  EXPECT_NEAR(EllipseDistance(thin, 8.0, 0.0), 3.0, 1e-12);
  EXPECT_NEAR(EllipseDistance(thin, 8.0, 4.0), 5.0, 1e-3);
}

}  // namespace
}  // namespace sim
