#include "control/road/halfspace.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

using Eigen::Vector2d;
constexpr double kPi = std::numbers::pi;

State At(double X, double Y, double psi) {
  State z = State::Zero();
  z[kX] = X;
  z[kY] = Y;
  z[kPsi] = psi;
  return z;
}

double Distance(const HalfSpace& halfspace, const Vector2d& point) {
  return halfspace.a * point.x() + halfspace.b * point.y() - halfspace.c;
}

Vector2d OnEllipse(const Obstacle& o, double margin, double angle) {
  const Vector2d local((o.r_x + margin) * std::cos(angle), (o.r_y + margin) * std::sin(angle));
  return Vector2d(o.X, o.Y) + Eigen::Rotation2Dd(o.heading) * local;
}

// Largest signed distance of the ellipse's points; 0 if the half-space's edge is a tangent.
double LargestDistance(const HalfSpace& halfspace, const Obstacle& o, double margin) {
  double largest = -1e300;
  for (int k = 0; k < 4000; ++k) {
    largest = std::max(largest, Distance(halfspace, OnEllipse(o, margin, k * 2.0 * kPi / 4000)));
  }
  return largest;
}

bool Inside(const Obstacle& o, double margin, const Vector2d& point) {
  const Vector2d local = Eigen::Rotation2Dd(-o.heading) * (point - Vector2d(o.X, o.Y));
  return std::hypot(local.x() / (o.r_x + margin), local.y() / (o.r_y + margin)) < 1.0;
}

Obstacle RandomObstacle(testing::Random& random, PassingSide side) {
  return {.X = random.Uniform(-100.0, 100.0),
          .Y = random.Uniform(-100.0, 100.0),
          .r_x = random.Uniform(0.3, 4.0),
          .r_y = random.Uniform(0.3, 4.0),
          .heading = random.Uniform(-kPi, kPi),
          .side = side};
}

TEST(ObstacleHalfSpace, NothingWhereTheReferenceIsOutside) {
  testing::Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Obstacle obstacle = RandomObstacle(random, PassingSide::kLeft);
    const Vector2d point(obstacle.X + random.Uniform(-6.0, 6.0), obstacle.Y + random.Uniform(-6.0, 6.0));
    const auto halfspace =
        ObstacleHalfSpace(obstacle, At(point.x(), point.y(), random.Uniform(-kPi, kPi)), 0.2);
    EXPECT_EQ(halfspace.has_value(), Inside(obstacle, 0.2, point));
  }
}

TEST(ObstacleHalfSpace, IsTheTangentWhereTheRoadsNormalLeavesTheEllipse) {
  testing::Random random(2);
  for (int i = 0; i < 300; ++i) {
    const bool left = random.Chance(0.5);
    const double margin = random.Uniform(0.0, 0.5), psi = random.Uniform(-kPi, kPi);
    const Obstacle obstacle = RandomObstacle(random, left ? PassingSide::kLeft : PassingSide::kRight);
    const Vector2d centre(obstacle.X, obstacle.Y);
    const Vector2d point =
        centre + random.Uniform(0.0, 0.95) * (OnEllipse(obstacle, margin, random.Uniform(0.0, 6.3)) - centre);
    const auto halfspace = ObstacleHalfSpace(obstacle, At(point.x(), point.y(), psi), margin);
    ASSERT_TRUE(halfspace);
    EXPECT_NEAR(std::hypot(halfspace->a, halfspace->b), 1.0, 1e-12);
    // The ellipse is beyond the edge and touches it, up to the height of a chord between samples.
    const double largest = LargestDistance(*halfspace, obstacle, margin);
    EXPECT_LT(largest, 1e-9);
    EXPECT_GT(largest, -1e-4);
    // The road's normal through the point meets the edge on the circumference.
    const Vector2d out = (left ? 1.0 : -1.0) * Vector2d(-std::sin(psi), std::cos(psi));
    const double along = halfspace->a * out.x() + halfspace->b * out.y();
    ASSERT_GT(along, 0.0) << "the way out leads into the half-space";
    const Vector2d q = point - Distance(*halfspace, point) / along * out;
    const Vector2d local = Eigen::Rotation2Dd(-obstacle.heading) * (q - centre);
    EXPECT_NEAR(std::hypot(local.x() / (obstacle.r_x + margin), local.y() / (obstacle.r_y + margin)), 1.0,
                1e-9);
  }
}

TEST(ObstacleHalfSpace, OfABoxExcludesTheWholeBox) {
  testing::Random random(3);
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    Obstacle box = RandomObstacle(random, random.Chance(0.5) ? PassingSide::kLeft : PassingSide::kUnknown);
    box.shape = ObstacleShape::kBox;
    const Eigen::Rotation2Dd turn(box.heading);
    const Vector2d point =
        turn * Vector2d(random.Uniform(-1.0, 1.0) * box.r_x, random.Uniform(-1.0, 1.0) * box.r_y);
    const auto halfspace =
        ObstacleHalfSpace(box, At(box.X + point.x(), box.Y + point.y(), random.Uniform(-kPi, kPi)), 0.0);
    ASSERT_TRUE(halfspace) << "a point of the box is outside";
    double largest = -1e300;
    for (const double ahead : {-1.0, 1.0}) {
      for (const double left : {-1.0, 1.0}) {
        const Vector2d corner = Vector2d(box.X, box.Y) + turn * Vector2d(ahead * box.r_x, left * box.r_y);
        largest = std::max(largest, Distance(*halfspace, corner));
      }
    }
    EXPECT_LT(largest, 1e-9);
    found += static_cast<int>(largest > -0.05);
  }
  EXPECT_GT(found, 30) << "no edge is near a corner";
}

TEST(ObstacleHalfSpace, OfACircleIsAtItsRadiusFromTheCentre) {
  const Obstacle circle{
      .X = 10.0, .Y = 0.3, .r_x = 1.0, .r_y = 1.0, .heading = 0.7, .side = PassingSide::kLeft};
  const auto halfspace = ObstacleHalfSpace(circle, At(10.0, 0.0, 0.0), 0.0);
  ASSERT_TRUE(halfspace);  // the point is above the centre
  EXPECT_NEAR(halfspace->a, 0.0, 1e-12);
  EXPECT_NEAR(halfspace->b, 1.0, 1e-12);
  EXPECT_NEAR(halfspace->c, 1.3, 1e-12);
  const auto before = ObstacleHalfSpace(circle, At(9.4, 0.0, 0.0), 0.0);
  ASSERT_TRUE(before);  // Q = (9.4, 0.3 + 0.8)
  EXPECT_NEAR(before->a, -0.6, 1e-12);
  EXPECT_NEAR(before->b, 0.8, 1e-12);
  EXPECT_NEAR(before->c, -0.6 * 10.0 + 0.8 * 0.3 + 1.0, 1e-12);
}

TEST(ObstacleHalfSpace, UnknownSideIsTheShorterWayOut) {
  Obstacle circle{.X = 0.0, .Y = -0.2, .side = PassingSide::kUnknown};
  EXPECT_GT(ObstacleHalfSpace(circle, At(0.0, 0.0, 0.0), 0.0)->b, 0.0);
  EXPECT_GT(ObstacleHalfSpace(circle, At(0.0, 0.0, kPi), 0.0)->b, 0.0);  // the same when driven the other way
  circle.Y = 0.2;
  EXPECT_LT(ObstacleHalfSpace(circle, At(0.0, 0.0, 0.0), 0.0)->b, 0.0);
}

TEST(ObstacleHalfSpace, GivenSideHoldsEvenIfItIsTheLongerWay) {
  const Obstacle circle{.X = 0.0, .Y = 0.8, .side = PassingSide::kLeft};
  EXPECT_NEAR(ObstacleHalfSpace(circle, At(0.0, 0.0, 0.0), 0.0)->c, 1.8, 1e-12);
}

TEST(ObstacleHalfSpace, MarginMovesTheEdgeOutByItself) {
  const Obstacle circle{.X = 3.0, .Y = 0.0, .r_x = 1.5, .r_y = 1.5, .side = PassingSide::kRight};
  const double without = ObstacleHalfSpace(circle, At(3.0, 0.0, 0.0), 0.0)->c;
  EXPECT_NEAR(ObstacleHalfSpace(circle, At(3.0, 0.0, 0.0), 0.4)->c - without, 0.4, 1e-12);
  EXPECT_FALSE(ObstacleHalfSpace(circle, At(3.0, 1.7, 0.0), 0.0));
  EXPECT_TRUE(ObstacleHalfSpace(circle, At(3.0, 1.7, 0.0), 0.4));
}

TEST(ObstacleHalfSpace, CentreOfTheObstacleHasAWayOut) {
  const Obstacle obstacle{.X = 1.0, .Y = 2.0, .r_x = 2.0, .r_y = 0.5, .heading = 0.4};
  const auto halfspace = ObstacleHalfSpace(obstacle, At(1.0, 2.0, 1.1), 0.1);
  ASSERT_TRUE(halfspace);
  EXPECT_LT(Distance(*halfspace, {1.0, 2.0}), 0.0);
}

}  // namespace
}  // namespace control
