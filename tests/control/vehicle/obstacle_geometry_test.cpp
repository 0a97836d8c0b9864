#include "control/vehicle/obstacle_geometry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "control/vehicle/geometry.hpp"
#include "tests/control/random.hpp"

namespace control {
namespace {

using Eigen::Vector2d;
constexpr double kPi = std::numbers::pi;
constexpr double kMargin = 0.4;

Obstacle Anywhere(testing::Random& random, ObstacleShape shape) {
  return {.X = random.Uniform(-5.0, 5.0),
          .Y = random.Uniform(-5.0, 5.0),
          .r_x = random.Uniform(0.1, 5.0),
          .r_y = random.Uniform(0.1, 5.0),
          .heading = random.Uniform(-kPi, kPi),
          .shape = shape};
}

// From the obstacle's centre.
std::array<Vector2d, 4> Corners(const Obstacle& box) {
  const Eigen::Rotation2Dd turn(box.heading);
  return {turn * Vector2d(box.r_x, box.r_y), turn * Vector2d(box.r_x, -box.r_y),
          turn * Vector2d(-box.r_x, -box.r_y), turn * Vector2d(-box.r_x, box.r_y)};
}

// Whether the enlarged obstacle covers a point, given from its centre.
bool Covers(const Obstacle& o, double margin, const Vector2d& point) {
  const Vector2d local = Eigen::Rotation2Dd(-o.heading) * point;
  if (o.shape == ObstacleShape::kBox)
    return (local.cwiseAbs() - Vector2d(o.r_x, o.r_y)).cwiseMax(0.0).norm() <= margin;
  return std::hypot(local.x() / (o.r_x + margin), local.y() / (o.r_y + margin)) <= 1.0;
}

// The greatest y such that the enlarged obstacle covers τ t + y n.
double EdgeAt(const Obstacle& o, double margin, const Vector2d& t, const Vector2d& n, double tau) {
  const double most = EnlargedObstacle(o, margin).Support(n) + 1e-6;
  double outside = most;
  while (outside > -most && !Covers(o, margin, tau * t + outside * n)) outside -= 1e-3 * most;
  double low = outside, high = outside + 1e-3 * most;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (Covers(o, margin, tau * t + middle * n) ? low : high) = middle;
  }
  return low;
}

TEST(EnlargedObstacle, SupportOfABoxIsThatOfItsFarthestCornerAndTheMargin) {
  testing::Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Obstacle box = Anywhere(random, ObstacleShape::kBox);
    const Vector2d direction = Along(random.Uniform(-kPi, kPi));
    double farthest = 0.0;
    for (const Vector2d& corner : Corners(box)) farthest = std::max(farthest, corner.dot(direction));
    EXPECT_NEAR(EnlargedObstacle(box).Support(direction), farthest, 1e-12);
    EXPECT_NEAR(EnlargedObstacle(box, kMargin).Support(direction), farthest + kMargin, 1e-12);
  }
}

// The line of this slope through the edge's point is a tangent: the whole obstacle is below it. The point is the one of
// the interval that is nearest to the widest place.
TEST(EnlargedObstacle, EdgeSlopeIsThatOfTheTangentInTheInterval) {
  testing::Random random(2);
  int inclined = 0, level = 0;
  for (int i = 0; i < 600; ++i) {
    const Obstacle o = Anywhere(random, i % 2 == 0 ? ObstacleShape::kBox : ObstacleShape::kEllipse);
    const double psi = random.Uniform(-kPi, kPi);
    const Vector2d t = Along(psi), n = i % 3 == 0 ? Vector2d(-LeftOf(psi)) : LeftOf(psi);
    const EnlargedObstacle enlarged(o, kMargin);
    const double half_length = enlarged.Support(t);
    const double rear = random.Uniform(-0.99, 0.99) * half_length;
    const double front = random.Uniform(rear, 0.99 * half_length);
    const double slope = enlarged.EdgeSlope(t, n, rear, front);
    if (std::abs(slope) > 20.0) continue;
    // The edge rises before its widest place and falls behind it.
    const double tau = slope > 0.0 ? front : rear;
    const double height = enlarged.Support((n - slope * t).normalized()) * std::hypot(1.0, slope);
    if (slope == 0.0) {
      ++level;
      const double widest = enlarged.Support(n);
      bool reached = false;
      for (int k = 0; k <= 200; ++k)
        reached = reached || EdgeAt(o, kMargin, t, n, rear + (front - rear) * k / 200) > widest - 0.05;
      EXPECT_TRUE(reached) << i;
    } else if (std::abs(slope) > 1e-9) {
      ++inclined;
      EXPECT_NEAR(EdgeAt(o, kMargin, t, n, tau) - slope * tau, height, 1e-6 * (1.0 + std::abs(slope))) << i;
    }
  }
  EXPECT_GT(inclined, 200);
  EXPECT_GT(level, 20);
}

TEST(EnlargedObstacle, EdgeOfABoxAlongTheRoadIsLevelBesideItAndInfinitelySteepBeyondIt) {
  const Obstacle box{.r_x = 4.0, .r_y = 1.0, .shape = ObstacleShape::kBox};
  const Vector2d t(1.0, 0.0), n(0.0, 1.0);
  for (const double margin : {0.0, kMargin}) {
    const EnlargedObstacle enlarged(box, margin);
    EXPECT_EQ(enlarged.EdgeSlope(t, n, -12.0, -3.9), 0.0);
    EXPECT_EQ(enlarged.EdgeSlope(t, n, -1.0, 1.0), 0.0);
    EXPECT_EQ(enlarged.EdgeSlope(t, n, 3.9, 12.0), 0.0);
    EXPECT_EQ(enlarged.EdgeSlope(t, n, -12.0, -4.5), std::numeric_limits<double>::infinity());
    EXPECT_EQ(enlarged.EdgeSlope(t, n, 4.5, 12.0), -std::numeric_limits<double>::infinity());
  }
}

TEST(Overlap, OfThingsFarApartIsTheDistanceOfTheCirclesAboutThem) {
  const Footprint car{.front = 3.0, .rear = 2.0, .half_width = 4.0};
  State z = State::Zero();
  z[kX] = 20.0;
  EXPECT_NEAR(Overlap({.r_x = 2.0, .r_y = 1.0}, car, z), -(20.0 - 5.0 - 2.0), 1e-12);
  EXPECT_NEAR(Overlap({.r_x = 4.0, .r_y = 3.0, .shape = ObstacleShape::kBox}, car, z), -(20.0 - 5.0 - 5.0),
              1e-12);
}

TEST(Overlap, WithABoxIsPositiveExactlyWhereTheTwoShareAPoint) {
  testing::Random random(3);
  const Footprint car{.front = 1.95, .rear = 2.3, .half_width = 0.9};
  int contacts = 0;
  for (int i = 0; i < 400; ++i) {
    const Obstacle box = Anywhere(random, ObstacleShape::kBox);
    State z = State::Zero();
    z.head<2>() << random.Uniform(-8.0, 8.0), random.Uniform(-8.0, 8.0);
    z[kPsi] = random.Uniform(-kPi, kPi);
    const auto shares_a_point = [&](double margin) {
      for (double x = -car.rear; x <= car.front; x += 0.025) {
        for (double y = -car.half_width; y <= car.half_width; y += 0.025) {
          const Vector2d point = Position(z) + Rotate(z[kPsi], Vector2d(x, y));
          if (Covers(box, margin, point - Vector2d(box.X, box.Y))) return true;
        }
      }
      return false;
    };
    const double overlap = Overlap(box, car, z);
    const bool contact = shares_a_point(0.0);
    contacts += static_cast<int>(contact);
    if (contact) {
      EXPECT_GE(overlap, 0.0) << i;
    } else {
      EXPECT_LT(overlap, 0.03) << i;  // the points may miss a touch
    }
    // Apart, the gap is no more than the distance.
    if (overlap < -0.05) {
      EXPECT_FALSE(shares_a_point(-overlap - 0.03)) << i;
    }
  }
  EXPECT_GT(contacts, 60);
  EXPECT_LT(contacts, 340);
}

TEST(EnclosingEllipse, PassesThroughTheCornersOfABoxAndLeavesAnEllipse) {
  testing::Random random(4);
  const Obstacle box = Anywhere(random, ObstacleShape::kBox);
  const Obstacle ellipse = EnclosingEllipse(box);
  EXPECT_EQ(ellipse.shape, ObstacleShape::kEllipse);
  for (const Vector2d& corner : Corners(box)) {
    EXPECT_TRUE(Covers(ellipse, 1e-9, corner));
    EXPECT_FALSE(Covers(ellipse, -1e-9, corner));
  }
  const Obstacle same = EnclosingEllipse(ellipse);
  EXPECT_EQ(same.r_x, ellipse.r_x);
  EXPECT_EQ(same.r_y, ellipse.r_y);
}

}  // namespace
}  // namespace control
