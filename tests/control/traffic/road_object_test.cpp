#include "control/traffic/road_object.hpp"

#include <cmath>
#include <numbers>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "gtest/gtest.h"
#include "tests/control/roads.hpp"

namespace control {
namespace {

constexpr double kRadius = 40.0;

class RoadObjectTest : public ::testing::Test {
 protected:
  // A car at arc length s on the circle, `lateral` beside its line, that moves along the road.
  static Obstacle CarOnCircle(double s, double lateral, double speed) {
    const double angle = s / kRadius, radius = kRadius - lateral;
    return {.X = radius * std::sin(angle),
            .Y = kRadius - radius * std::cos(angle),
            .r_x = 2.2,
            .r_y = 0.9,
            .heading = angle,
            .velocity_X = speed * std::cos(angle),
            .velocity_Y = speed * std::sin(angle),
            .shape = ObstacleShape::kBox};
  }

  RoadProfile straight_{testing::StraightRoad(200.0, 12.0), {}, {}};
  RoadProfile circle_{testing::CircularRoad(kRadius, 0.9, 12.0), {}, {}};
};

TEST_F(RoadObjectTest, IsPlacedBesideItsNearestPointWithItsExtentsAlongAndAcrossTheRoad) {
  Obstacle lorry{.X = 60.0, .Y = -2.0, .r_x = 6.0, .r_y = 1.25, .shape = ObstacleShape::kBox};
  const RoadObject along = PlaceOnRoad(lorry, 3, straight_, 55.0);
  EXPECT_EQ(along.index, 3u);
  EXPECT_NEAR(along.s, 60.0, 1e-9);
  EXPECT_NEAR(along.lateral, -2.0, 1e-9);
  EXPECT_NEAR(along.half_length, 6.0, 1e-9);
  EXPECT_NEAR(along.half_width, 1.25, 1e-9);
  lorry.heading = 0.5 * std::numbers::pi;
  const RoadObject across = PlaceOnRoad(lorry, 0, straight_, 55.0);
  EXPECT_NEAR(across.half_length, 1.25, 1e-9);
  EXPECT_NEAR(across.half_width, 6.0, 1e-9);
  lorry.heading = 0.25 * std::numbers::pi;
  EXPECT_NEAR(PlaceOnRoad(lorry, 0, straight_, 55.0).half_width, (6.0 + 1.25) / std::sqrt(2.0), 1e-9);
  lorry.shape = ObstacleShape::kEllipse;
  EXPECT_NEAR(PlaceOnRoad(lorry, 0, straight_, 55.0).half_width, std::hypot(6.0, 1.25) / std::sqrt(2.0),
              1e-9);
}

TEST_F(RoadObjectTest, ItsVelocityIsSplitByTheRoadsDirectionThere) {
  const Obstacle car = CarOnCircle(30.0, 2.0, 9.0);
  const RoadObject object = PlaceOnRoad(car, 0, circle_, 25.0);
  EXPECT_NEAR(object.s, 30.0, 1e-2);
  EXPECT_NEAR(object.lateral, 2.0, 1e-2);
  EXPECT_NEAR(object.speed, 9.0, 1e-3);
  EXPECT_NEAR(object.drift, 0.0, 1e-2);
  EXPECT_FALSE(object.crosses);
}

TEST_F(RoadObjectTest, WhetherItCrossesIsDecidedByTheDirectionOfItsMotion) {
  const auto crosses = [this](double along, double across) {
    const Obstacle o{.X = 50.0, .velocity_X = along, .velocity_Y = across};
    return PlaceOnRoad(o, 0, straight_, 50.0).crosses;
  };
  EXPECT_TRUE(crosses(0.0, 1.4));
  EXPECT_TRUE(crosses(1.0, -1.4));
  EXPECT_FALSE(crosses(12.0, 1.4)) << "it changes lanes";
  EXPECT_FALSE(crosses(-12.0, -1.4));
}

TEST_F(RoadObjectTest, OneThatChangesLanesDoesNotDriftForEver) {
  const RoadObject lane_changer{.lateral = -2.0, .speed = 10.0, .drift = 1.0};
  EXPECT_NEAR(lane_changer.LateralAt(1.0), -1.0, 1e-12);
  EXPECT_NEAR(lane_changer.LateralAt(8.0), -2.0 + RoadObject::kDrift, 1e-12);
  const RoadObject pedestrian{.lateral = -2.0, .drift = 1.0, .crosses = true};
  EXPECT_NEAR(pedestrian.LateralAt(8.0), 6.0, 1e-12);
}

TEST_F(RoadObjectTest, OneThatMovesAlongTheRoadFollowsItsBend) {
  const Obstacle car = CarOnCircle(30.0, 2.0, 9.0);
  const RoadObject object = PlaceOnRoad(car, 0, circle_, 25.0);
  for (const double time : {0.0, 1.0, 4.0}) {
    const Obstacle moved = Predict(car, object, circle_, time);
    const Obstacle expected = CarOnCircle(30.0 + 9.0 * time, 2.0, 9.0);
    EXPECT_NEAR(moved.X, expected.X, 0.02) << time;
    EXPECT_NEAR(moved.Y, expected.Y, 0.02) << time;
    EXPECT_NEAR(moved.heading, expected.heading, 1e-3) << time;
    EXPECT_EQ(moved.r_x, car.r_x);
  }
}

TEST_F(RoadObjectTest, OneThatCrossesTheRoadMovesStraight) {
  Obstacle pedestrian = CarOnCircle(30.0, -6.0, 0.0);
  const Eigen::Vector2d left = LeftOf(30.0 / kRadius);
  pedestrian.velocity_X = 1.5 * left.x();
  pedestrian.velocity_Y = 1.5 * left.y();
  const RoadObject object = PlaceOnRoad(pedestrian, 0, circle_, 30.0);
  EXPECT_TRUE(object.crosses);
  EXPECT_NEAR(object.LateralAt(4.0), 0.0, 1e-2);
  const Obstacle moved = Predict(pedestrian, object, circle_, 4.0);
  EXPECT_NEAR(moved.X, pedestrian.X + 6.0 * left.x(), 1e-9);
  EXPECT_NEAR(moved.Y, pedestrian.Y + 6.0 * left.y(), 1e-9);
  EXPECT_EQ(moved.heading, pedestrian.heading);
}

}  // namespace
}  // namespace control
