#include "sim/free_way.hpp"

#include <vector>

#include "gtest/gtest.h"

namespace sim {
namespace {

constexpr control::Footprint kCar{.front = 2.2, .rear = 2.5, .half_width = 0.9};
constexpr control::RoadBounds kRoad{.left = 4.0, .right = -4.0};

RoadBody Car(double lateral = 0.0, double heading = 0.0) {
  return {.s = 20.0,
          .lateral = lateral,
          .heading = heading,
          .rear = 17.5,
          .front = 22.2,
          .right = lateral - 0.9,
          .left = lateral + 0.9};
}

// `gap` [m]: from the vehicle's front.
RoadBody Object(double gap, double length, double right, double left, double speed = 0.0,
                double lateral_speed = 0.0) {
  return {.s = 22.2 + gap + 0.5 * length,
          .lateral = 0.5 * (right + left),
          .rear = 22.2 + gap,
          .front = 22.2 + gap + length,
          .right = right,
          .left = left,
          .speed = speed,
          .lateral_speed = lateral_speed};
}

bool IsFree(const std::vector<RoadBody>& objects, const RoadBody& vehicle = Car(),
            const control::RoadBounds& road = kRoad) {
  return WayIsFree(vehicle, kCar, 1.5, objects, road);
}

TEST(FreeWay, EmptyRoadIsFree) {
  EXPECT_TRUE(IsFree({}));
}

TEST(FreeWay, WallAcrossTheRoadIsNot) {
  EXPECT_FALSE(IsFree({Object(8.0, 1.0, -4.0, 4.0)}));
}

TEST(FreeWay, WallFurtherAwayThanTheVehicleLooksDoesNotMatter) {
  EXPECT_TRUE(IsFree({Object(15.5, 1.0, -4.0, 4.0)}));
  EXPECT_FALSE(IsFree({Object(14.0, 1.0, -4.0, 4.0)}));
}

TEST(FreeWay, GapMustHoldTheVehicleAndItsMargin) {
  // The vehicle is 1.8 m wide and has 0.3 m on either side.
  EXPECT_TRUE(IsFree({Object(8.0, 4.0, -4.0, -1.21), Object(8.0, 4.0, 1.21, 4.0)}));
  EXPECT_FALSE(IsFree({Object(8.0, 4.0, -4.0, -1.15), Object(8.0, 4.0, 1.15, 4.0)}));
}

TEST(FreeWay, RoadThatIsTooNarrowIsNotFree) {
  EXPECT_TRUE(IsFree({}, Car(), {.left = 1.21, .right = -1.21}));
  EXPECT_FALSE(IsFree({}, Car(), {.left = 1.15, .right = -1.15}));
}

TEST(FreeWay, ParkedCarCanBePassedIfThereIsRoomToTurnOut) {
  // On a circle of 6 m radius about the rear axle, the front right corner needs a gap of 2.24 m to pass.
  const auto parked = [](double gap) { return Object(gap, 4.5, -0.9, 0.9); };
  EXPECT_TRUE(IsFree({parked(5.0)}));
  EXPECT_TRUE(IsFree({parked(2.8)}));
  EXPECT_FALSE(IsFree({parked(1.9)}));
}

TEST(FreeWay, CarOnTheOnlyWayPastMayBeOneThatIsComing) {
  const RoadBody parked = Object(5.0, 4.5, -4.0, 0.5), oncoming = Object(40.0, 4.5, 1.5, 3.5, -10.0);
  EXPECT_TRUE(IsFree({parked}, Car(-1.0)));
  EXPECT_FALSE(IsFree({parked, oncoming}, Car(-1.0)));
  EXPECT_TRUE(IsFree({parked, Object(80.0, 4.5, 1.5, 3.5, -10.0)}, Car(-1.0)));
}

TEST(FreeWay, FollowerBehindIsNotInTheWayButAnOvertakerIs) {
  const RoadBody parked = Object(5.0, 4.5, -4.0, 0.5);
  EXPECT_TRUE(IsFree({parked, Object(-14.0, 4.5, -0.9, 0.9, 10.0)}));
  EXPECT_FALSE(IsFree({parked, Object(-14.0, 4.5, 1.5, 3.5, 10.0)}));
}

TEST(FreeWay, PedestrianWhoWillCrossIsInTheWay) {
  EXPECT_FALSE(IsFree({Object(6.0, 0.6, -3.9, -3.3, 0.0, 1.5), Object(6.0, 0.6, 2.5, 4.0)}));
  EXPECT_TRUE(IsFree({Object(6.0, 0.6, -3.9, -3.3), Object(6.0, 0.6, 2.5, 4.0)}));
}

TEST(FreeWay, VehicleThatStandsAskewTurnsBackFirst) {
  EXPECT_TRUE(IsFree({}, Car(2.0, 0.4)));
  EXPECT_FALSE(IsFree({}, Car(2.0, 1.0)));  // its front is off the road before it has turned
}

TEST(FreeWay, VehicleBesideAWallMayDriveAwayFromIt) {
  EXPECT_TRUE(IsFree({Object(-5.0, 30.0, 1.0, 4.0)}));
  EXPECT_FALSE(IsFree({Object(-5.0, 30.0, 1.0, 4.0)}, Car(0.0), {.left = 4.0, .right = -1.3}));
}

}  // namespace
}  // namespace sim
