#include "control/road/keep_out.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <rapidcheck/gtest.h>

namespace control {
namespace {

using Eigen::Vector2d;
constexpr double kPi = std::numbers::pi;
constexpr Footprint kCar{.front = 2.0, .rear = 2.3, .half_width = 0.9};

Vector2d Along(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

Vector2d Left(double angle) {
  return {-std::sin(angle), std::cos(angle)};
}

double Distance(const HalfSpace& half_space, const Vector2d& point) {
  return Vector2d(half_space.a, half_space.b).dot(point) - half_space.c;
}

Vector2d OnEllipse(const Obstacle& o, double margin, double angle) {
  const Vector2d local((o.r_x + margin) * std::cos(angle), (o.r_y + margin) * std::sin(angle));
  return Vector2d(o.X, o.Y) + Eigen::Rotation2Dd(o.heading) * local;
}

// A box's corners, relative to its centre.
std::array<Vector2d, 4> CornersOf(const Obstacle& o) {
  const Eigen::Rotation2Dd turn(o.heading);
  return {turn * Vector2d(o.r_x, o.r_y), turn * Vector2d(-o.r_x, o.r_y), turn * Vector2d(-o.r_x, -o.r_y),
          turn * Vector2d(o.r_x, -o.r_y)};
}

// The edge's farthest point in a direction, relative to the obstacle's centre.
Vector2d Farthest(const Obstacle& o, double margin, const Vector2d& direction) {
  Vector2d farthest = Vector2d::Zero();
  if (o.shape == ObstacleShape::kBox) {
    for (const Vector2d& corner : CornersOf(o)) {
      if (corner.dot(direction) > farthest.dot(direction)) farthest = corner;
    }
    return farthest + margin * direction;
  }
  for (int k = 0; k < 720; ++k) {
    const Vector2d point = OnEllipse(o, margin, k * kPi / 360) - Vector2d(o.X, o.Y);
    if (point.dot(direction) > farthest.dot(direction)) farthest = point;
  }
  return farthest;
}

bool Inside(const Obstacle& o, double margin, const Vector2d& point) {
  const Vector2d local = Eigen::Rotation2Dd(-o.heading) * (point - Vector2d(o.X, o.Y));
  if (o.shape == ObstacleShape::kBox) {
    const Vector2d beyond = (local.cwiseAbs() - Vector2d(o.r_x, o.r_y)).cwiseMax(0.0);
    return margin > 0.0 ? beyond.norm() < margin - 1e-9 : beyond.norm() == 0.0;
  }
  return std::hypot(local.x() / (o.r_x + margin), local.y() / (o.r_y + margin)) < 1.0 - 1e-9;
}

// A vehicle on the road of heading psi_road, `along` beyond the obstacle's centre and `beside` left of it.
State AtObstacle(const Obstacle& o, double psi_road, double along, double beside, double yaw = 0.0) {
  State z = State::Zero();
  z.head<2>() = Vector2d(o.X, o.Y) + along * Along(psi_road) + beside * Left(psi_road);
  z[kPsi] = psi_road + yaw;
  return z;
}

double Between(double low, double high) {
  const auto parts = rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1'000'001));
  return low + (high - low) * 1e-6 * *parts;
}

// An encounter of a vehicle and an obstacle that is near enough to matter.
struct Encounter {
  Obstacle obstacle{.X = Between(-50.0, 50.0),
                    .Y = Between(-50.0, 50.0),
                    .r_x = Between(0.1, 5.0),
                    .r_y = Between(0.1, 5.0),
                    .heading = Between(-kPi, kPi),
                    .shape = *rc::gen::element(ObstacleShape::kEllipse, ObstacleShape::kBox)};
  PassingSide side = *rc::gen::element(PassingSide::kLeft, PassingSide::kRight);
  double psi_road = Between(-kPi, kPi);
  double margin = Between(0.0, 0.5);
  double half_length = Farthest(obstacle, margin, Along(psi_road)).dot(Along(psi_road));
  double along = Between(-half_length - kCar.front, half_length + kCar.rear);
  State z = AtObstacle(obstacle, psi_road, along, Between(-5.0, 5.0), Between(-0.6, 0.6));

  [[nodiscard]] std::optional<HalfSpace> Passing() const {
    return PassingHalfSpace(obstacle, side, z, Along(psi_road), kCar, margin, 1.0);
  }
  // Unit vector to the side on which the obstacle is passed.
  [[nodiscard]] Vector2d Aside() const {
    return side == PassingSide::kLeft ? Left(psi_road) : Vector2d(-Left(psi_road));
  }
};

RC_GTEST_PROP(PassingHalfSpace, VehicleWhoseCornersAreBeyondItDoesNotTouchTheEnlargedObstacle, ()) {
  const Encounter e;
  const auto outside = e.Passing();
  RC_ASSERT(outside.has_value());
  // The vehicle is moved until its nearest corner is on the edge.
  Vector2d position(e.z[kX], e.z[kY]);
  const Eigen::Rotation2Dd turn(e.z[kPsi]);
  double nearest = 1e300;
  for (const Vector2d& corner : kCar.Corners())
    nearest = std::min(nearest, Distance(*outside, position + turn * corner));
  position -= nearest * Vector2d(outside->a, outside->b);
  for (double x = -kCar.rear; x <= kCar.front; x += 0.1) {
    for (double y = -kCar.half_width; y <= kCar.half_width; y += 0.1) {
      RC_ASSERT(!Inside(e.obstacle, e.margin, position + turn * Vector2d(x, y)));
    }
  }
}

RC_GTEST_PROP(PassingHalfSpace, TouchesTheObstacleAndLeavesRoomOnTheSideOfPassing, ()) {
  const Encounter e;
  const auto outside = e.Passing();
  RC_ASSERT(outside.has_value());
  const Vector2d normal(outside->a, outside->b);
  const Vector2d tangent_point =
      Vector2d(e.obstacle.X, e.obstacle.Y) + Farthest(e.obstacle, e.margin, normal);
  RC_ASSERT(std::abs(Distance(*outside, tangent_point)) < 1e-3);
  RC_ASSERT(std::abs(std::hypot(outside->a, outside->b) - 1.0) < 1e-12);
  RC_ASSERT(normal.dot(e.Aside()) >= std::numbers::sqrt2 / 2.0 - 1e-9);  // 45°
}

RC_GTEST_PROP(PassingHalfSpace, WhileTheVehicleIsBesideTheWidestPlaceItsEdgeIsAlongTheRoad, ()) {
  Encounter e;
  const double widest = Farthest(e.obstacle, e.margin, e.Aside()).dot(Along(e.psi_road));
  constexpr double kSampling = 0.1;
  e.z = AtObstacle(e.obstacle, e.psi_road, widest + Between(kSampling - kCar.front, kCar.rear - kSampling),
                   0.0);
  const auto outside = e.Passing();
  RC_ASSERT(outside.has_value());
  RC_ASSERT((Vector2d(outside->a, outside->b) - e.Aside()).norm() < 1e-9);
}

RC_GTEST_PROP(PassingHalfSpace, ThereIsNoneFurtherThanItsReach, ()) {
  Encounter e;
  const double reach = Between(0.1, 3.0);
  for (const double beyond : {-0.01, 0.01}) {
    const double before = -e.half_length - reach - kCar.front - beyond;
    const double behind = e.half_length + reach + kCar.rear + beyond;
    for (const double along : {before, behind}) {
      e.z = AtObstacle(e.obstacle, e.psi_road, along, 0.0);
      const auto outside =
          PassingHalfSpace(e.obstacle, e.side, e.z, Along(e.psi_road), kCar, e.margin, reach);
      RC_ASSERT(outside.has_value() == (beyond < 0.0));
    }
  }
}

TEST(PassingHalfSpace, BeforeTheObstacleItsEdgeTurnsTowardsTheVehicle) {
  const Obstacle circle{.X = 10.0, .Y = 1.0, .r_x = 2.0, .r_y = 2.0};
  const auto side = [&](double along, PassingSide passing) {
    return *PassingHalfSpace(circle, passing, AtObstacle(circle, 0.0, along, 0.0), Along(0.0), kCar, 0.0,
                             1.0);
  };
  // The front is 1 m short of the circle's centre, where the circumference has slope 1/√3.
  const HalfSpace before = side(-3.0, PassingSide::kLeft);
  EXPECT_NEAR(-before.a / before.b, 1.0 / std::sqrt(3.0), 1e-9);
  const HalfSpace behind = side(3.3, PassingSide::kLeft);
  EXPECT_NEAR(behind.a, -before.a, 1e-9);
  const HalfSpace right = side(-3.0, PassingSide::kRight);
  EXPECT_NEAR(right.a, before.a, 1e-9);
  EXPECT_NEAR(right.b, -before.b, 1e-9);
}

TEST(PassingHalfSpace, BeforeABoxItsEdgeTurnsAboutTheCornerAndIsAlongTheRoadBesideIt) {
  const Obstacle lorry{.X = 10.0, .Y = 1.0, .r_x = 8.0, .r_y = 1.25, .shape = ObstacleShape::kBox};
  constexpr double kMargin = 0.4;
  const auto left = [&](double front) {
    const State z = AtObstacle(lorry, 0.0, front - kCar.front, 0.0);
    return *PassingHalfSpace(lorry, PassingSide::kLeft, z, Along(0.0), kCar, kMargin, 1.0);
  };
  // The front is beside the lorry: its side and the margin.
  for (const double front : {-8.0, -3.0, 8.0}) {
    EXPECT_NEAR(left(front).a, 0.0, 1e-12);
    EXPECT_NEAR(left(front).b, 1.0, 1e-12);
    EXPECT_NEAR(left(front).c, 1.0 + 1.25 + kMargin, 1e-12);
  }
  // The front is half the margin short of the lorry: the arc's normal leans back by 30°, about the corner.
  const HalfSpace before = left(-8.2);
  EXPECT_NEAR(before.a, -0.5, 1e-9);
  EXPECT_NEAR(Distance(before, {2.0, 2.25}), -kMargin, 1e-9);
  // Further away, it is 45° however steep the lorry's rear is.
  EXPECT_NEAR(left(-8.6).a, -std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(left(-9.0).a, -std::sqrt(0.5), 1e-12);
}

TEST(PassingHalfSpace, ASideOfABoxAtAnAngleIsFollowed) {
  const Obstacle box{
      .X = 0.0, .Y = 0.0, .r_x = 4.0, .r_y = 1.0, .heading = 0.3, .shape = ObstacleShape::kBox};
  // Its left side rises from the rear corner to the front corner; the vehicle's front is in between.
  const State z = AtObstacle(box, 0.0, -kCar.front, 0.0);
  const HalfSpace outside = *PassingHalfSpace(box, PassingSide::kLeft, z, Along(0.0), kCar, 0.0, 1.0);
  EXPECT_NEAR(outside.a, -std::sin(0.3), 1e-12);
  EXPECT_NEAR(outside.c, 1.0, 1e-12);
}

RC_GTEST_PROP(HalfSpaceBefore, EndsAtTheObstacleAcrossTheRoad, ()) {
  const Encounter e;
  const HalfSpace outside = HalfSpaceBefore(e.obstacle, Along(e.psi_road), e.margin);
  RC_ASSERT((Vector2d(outside.a, outside.b) + Along(e.psi_road)).norm() < 1e-12);
  const Vector2d nearest =
      Vector2d(e.obstacle.X, e.obstacle.Y) + Farthest(e.obstacle, e.margin, -Along(e.psi_road));
  RC_ASSERT(std::abs(Distance(outside, nearest)) < 1e-3);
}

RC_GTEST_PROP(SupportOf, IsTheLargestExtentInADirection, ()) {
  const Encounter e;
  const Vector2d direction = Along(e.psi_road);
  const double largest = Farthest(e.obstacle, 0.0, direction).dot(direction);
  RC_ASSERT(std::abs(SupportOf(e.obstacle, direction) - largest) < 1e-3);
}

TEST(Predict, ChangesThePlaceAlone) {
  const Obstacle before{.id = 4,
                        .X = 1.0,
                        .Y = 2.0,
                        .r_x = 3.0,
                        .r_y = 0.5,
                        .heading = 0.3,
                        .velocity_X = -2.0,
                        .velocity_Y = 4.0,
                        .side = PassingSide::kRight,
                        .shape = ObstacleShape::kBox,
                        .object_class = ObstacleClass::kVehicle};
  const Obstacle after = Predict(before, 0.5);
  EXPECT_EQ(after.X, 0.0);
  EXPECT_EQ(after.Y, 4.0);
  EXPECT_EQ(after.id, before.id);
  EXPECT_EQ(after.r_x, before.r_x);
  EXPECT_EQ(after.r_y, before.r_y);
  EXPECT_EQ(after.heading, before.heading);
  EXPECT_EQ(after.side, before.side);
  EXPECT_EQ(after.shape, before.shape);
  EXPECT_EQ(after.object_class, before.object_class);
}

}  // namespace
}  // namespace control
