#include "control/traffic/road_objects.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/roads.hpp"

namespace control {
namespace {

constexpr Footprint kFootprint{.front = 2.0, .rear = 2.3, .half_width = 0.9};
constexpr double kTime = 8.0;
constexpr double kEps = 1e-6;
constexpr double kBeside = 0.5;  // beyond the road's edge, within which an object counts as on it [m]

std::vector<RoadObject> Select(const RoadProfile& profile, const std::vector<Obstacle>& obstacles,
                               const RoadPosition& vehicle, double distance) {
  RoadObjects objects(kFootprint, kTime, profile);
  objects.Select(obstacles, vehicle, distance);
  return {objects.objects().begin(), objects.objects().end()};
}

// A straight road in X direction from −4 m to 4 m, on which the vehicle is at X = 100 m and drives at 10 m/s.
class OnStraightRoad : public ::testing::Test {
 protected:
  static constexpr RoadPosition kVehicle{.s = 100.0, .speed = 10.0};
  static constexpr double kDistance = 80.0;

  static Obstacle At(double ahead, double Y, double velocity_X = 0.0, double velocity_Y = 0.0) {
    return {.X = 100.0 + ahead, .Y = Y, .velocity_X = velocity_X, .velocity_Y = velocity_Y};  // radius 1 m
  }
  bool Matters(const Obstacle& obstacle) const {
    return !Select(profile_, {obstacle}, kVehicle, kDistance).empty();
  }

  RoadProfile profile_{testing::StraightRoad(500.0, 12.0), RoadBounds{.left = 4.0, .right = -4.0}, {}};
};

TEST_F(OnStraightRoad, ObjectOffTheRoadDoesNotMatterUnlessItComesOntoIt) {
  const double edge = 4.0 + kBeside + 1.0;
  EXPECT_TRUE(Matters(At(40.0, 0.0)));
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(Matters(At(40.0, side * (edge - kEps))));
    EXPECT_FALSE(Matters(At(40.0, side * (edge + kEps))));
    EXPECT_TRUE(Matters(At(40.0, side * 10.0, 0.0, side * -1.0))) << "a pedestrian who comes onto the road";
    EXPECT_FALSE(Matters(At(40.0, side * 10.0, 0.0, side * 1.0)));
    EXPECT_FALSE(Matters(At(40.0, side * 10.0, 0.0, side * -0.5))) << "too late: within 8 s it comes to 6 m";
  }
}

TEST_F(OnStraightRoad, ObjectMattersFromTheVehiclesRearEndToItsFrontAtTheHorizon) {
  EXPECT_TRUE(Matters(At(-2.3 - 1.0 + kEps, 3.0)));
  EXPECT_FALSE(Matters(At(-2.3 - 1.0 - kEps, 3.0)));
  EXPECT_TRUE(Matters(At(kDistance + 2.0 + 1.0 - kEps, 0.0)));
  EXPECT_FALSE(Matters(At(kDistance + 2.0 + 1.0 + kEps, 0.0)));
}

TEST_F(OnStraightRoad, OncomingObjectMattersFromFartherAway) {
  EXPECT_TRUE(Matters(At(kDistance + 3.0 + 10.0 * kTime - 0.01, 2.0, -10.0)));
  EXPECT_FALSE(Matters(At(kDistance + 3.0 + 10.0 * kTime + 0.01, 2.0, -10.0)));
  EXPECT_FALSE(Matters(At(kDistance + 3.0 + 10.0 * kTime - 0.01, 2.0, 10.0)));
}

TEST_F(OnStraightRoad, BehindOnlyAFasterOneInAnotherLaneMatters) {
  EXPECT_FALSE(Matters(At(-15.0, 0.0, 16.0))) << "it follows";
  EXPECT_FALSE(Matters(At(-15.0, 1.9 - kEps, 16.0))) << "it overlaps the vehicle's lane";
  EXPECT_TRUE(Matters(At(-15.0, 1.9 + kEps, 16.0))) << "it overtakes";
  EXPECT_TRUE(Matters(At(-15.0, -3.0, 16.0)));
  EXPECT_FALSE(Matters(At(-15.0, 3.0, 10.0))) << "no faster";
  EXPECT_FALSE(Matters(At(-15.0, 3.0, -16.0))) << "it has been met";
  EXPECT_FALSE(Matters(At(-15.0, 3.0))) << "passed";
  EXPECT_TRUE(Matters(At(-4.0, 3.0, 16.0)));
}

TEST_F(OnStraightRoad, AreSortedByTheirNearEndsWhateverTheirOrder) {
  Obstacle lorry = At(45.0, -2.0);
  lorry.r_x = 10.0;
  const auto objects =
      Select(profile_, {At(60.0, 0.0), At(38.0, 2.0), lorry, At(20.0, 0.0)}, kVehicle, kDistance);
  ASSERT_EQ(objects.size(), 4u);
  EXPECT_EQ(objects[0].index, 3u);
  EXPECT_EQ(objects[1].index, 2u) << "begins 35 m ahead";
  EXPECT_EQ(objects[2].index, 1u) << "begins 37 m ahead";
  EXPECT_EQ(objects[3].index, 0u);
}

TEST_F(OnStraightRoad, OfMoreThanTheMostTheNearestAreKeptAndTheOthersCounted) {
  std::vector<Obstacle> cones;
  for (int k = 40; k-- > 0;) cones.push_back(At(5.0 + 1.5 * k, 3.0));
  RoadObjects objects(kFootprint, kTime, profile_);
  objects.Select(cones, kVehicle, kDistance);
  ASSERT_EQ(objects.objects().size(), RoadObjects::kMost);
  EXPECT_EQ(objects.left_out(), 40u - RoadObjects::kMost);
  for (std::size_t k = 0; k < RoadObjects::kMost; ++k) {
    EXPECT_NEAR(objects.objects()[k].s, 105.0 + 1.5 * static_cast<double>(k), 1e-9);
  }
  objects.Select(std::span(cones).first(5), kVehicle, kDistance);
  EXPECT_EQ(objects.left_out(), 0u);
  objects.Select({}, kVehicle, kDistance);
  EXPECT_TRUE(objects.objects().empty());
}

TEST(RoadObjects, ObjectElsewhereAlongAHairpinIsOnItsOwnLegAlone) {
  const RoadProfile profile(testing::HairpinRoad(60.0, 12.0, 8.0), RoadBounds{.left = 4.0, .right = -4.0},
                            {});
  const double second_leg = 60.0 + 0.5 * std::numbers::pi * 12.0;
  const Obstacle on_second{.X = 30.0, .Y = 12.0};
  const auto objects = Select(profile, {on_second}, {.s = 20.0, .speed = 8.0}, 120.0);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_NEAR(objects[0].s, second_leg + 30.0, 0.05);
  EXPECT_NEAR(objects[0].lateral, 0.0, 0.05);
  EXPECT_TRUE(Select(profile, {on_second}, {.s = 20.0, .speed = 8.0}, 50.0).empty()) << "beyond the horizon";
}

TEST(RoadObjects, TreeBeyondAHairpinsEdgeIsNotOnTheRoad) {
  const RoadProfile profile(testing::HairpinRoad(60.0, 12.0, 8.0), RoadBounds{.left = 4.0, .right = -4.0},
                            {});
  const Obstacle tree{.X = 60.0 + 6.0 + 4.0 + 2.0 + 0.5, .Y = 6.0, .r_x = 0.5, .r_y = 0.5};
  EXPECT_TRUE(Select(profile, {tree}, {.s = 30.0, .speed = 8.0}, 120.0).empty());
  const Obstacle cone{.X = 60.0 + 6.0 + 3.0, .Y = 6.0, .r_x = 0.2, .r_y = 0.2};
  EXPECT_EQ(Select(profile, {cone}, {.s = 30.0, .speed = 8.0}, 120.0).size(), 1u);
}

TEST(RoadObjects, OnAnOutAndBackCourseOneObjectIsBesideBothLegs) {
  const RoadProfile profile(testing::HairpinRoad(60.0, 6.0, 8.0), RoadBounds{.left = 4.0, .right = -4.0}, {});
  const Obstacle between{.X = 30.0, .Y = 3.0, .velocity_X = 2.0};
  const auto objects = Select(profile, {between}, {.s = 10.0, .speed = 8.0}, 120.0);
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_NEAR(objects[0].s, 30.0, 0.05);
  EXPECT_NEAR(objects[1].s, 60.0 + 0.5 * std::numbers::pi * 6.0 + 30.0, 0.05);
  for (const RoadObject& object : objects) {
    EXPECT_EQ(object.index, 0u);
    EXPECT_NEAR(object.lateral, 3.0, 0.05);
  }
  EXPECT_NEAR(objects[0].speed, 2.0, 1e-3);
  EXPECT_NEAR(objects[1].speed, -2.0, 1e-3) << "on the way back, it comes towards the vehicle";
}

TEST(RoadObjects, AtACrossingOneObjectIsOnBothParts) {
  // 50 m straight on, three quarters of a circle to the left, and back across the first part at X = 35 m.
  constexpr double kRadius = 15.0;
  constexpr double kArc = 1.5 * std::numbers::pi * kRadius;
  const Route route = Route::FromPieces(
      {}, 8.0,
      std::array{RoutePiece{.length = 50.0},
                 RoutePiece{.length = kArc, .curvature_from = 1.0 / kRadius, .curvature_to = 1.0 / kRadius},
                 RoutePiece{.length = 60.0}});
  const RoadProfile profile(route, RoadBounds{.left = 4.0, .right = -4.0}, {});
  const Obstacle box{.X = 35.0, .Y = 0.0, .r_x = 2.0, .r_y = 1.0, .shape = ObstacleShape::kBox};
  const auto objects = Select(profile, {box}, {.s = 10.0, .speed = 8.0}, 150.0);
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_NEAR(objects[0].s, 35.0, 0.05);
  EXPECT_NEAR(objects[0].half_length, 2.0, 1e-3);
  EXPECT_NEAR(objects[1].s, 50.0 + kArc + kRadius, 0.05);
  EXPECT_NEAR(objects[1].half_length, 1.0, 1e-3);
  EXPECT_EQ(Select(profile, {box}, {.s = 60.0, .speed = 8.0}, 150.0).size(), 1u) << "it has been passed once";
}

}  // namespace
}  // namespace control
