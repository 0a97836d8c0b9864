// What the traffic planner decides about people and vehicles that move.
#include <algorithm>
#include <cmath>
#include <vector>

#include "control/traffic/traffic_planner.hpp"
#include "gtest/gtest.h"
#include "tests/control/traffic/planned_traffic.hpp"

namespace control {
namespace {

using MovingTraffic = testing::PlannedTraffic;

// The same between edges at −1.9 m and 1.5 m.
class NarrowRoad : public testing::PlannedTraffic {
 protected:
  NarrowRoad() : PlannedTraffic(RoadBounds{.left = 1.5, .right = -1.9}) {}
};

// The vehicle's lane in the middle and one for oncoming traffic on the left.
class TwoLanes : public testing::PlannedTraffic {
 protected:
  TwoLanes() : PlannedTraffic(RoadBounds{.left = 5.25, .right = -1.75}) {}
};

TEST_F(MovingTraffic, ObstacleThatCrossesIsJudgedWhereItIsMet) {
  Obstacle crossing = At(38.6, -3.0, 0.6);  // its near end is 36 m ahead of the front: met in 3 s
  EXPECT_EQ(SideOf(crossing), Side::kLeft);
  crossing.velocity_Y = 1.5;  // then at Y = 1.5 m
  EXPECT_EQ(SideOf(crossing), Side::kRight);
  crossing.velocity_Y = 3.0;  // then off the road on the other side
  EXPECT_EQ(SideOf(crossing), Side::kRight);
}

TEST_F(MovingTraffic, ObstacleThatIsNotMetDoesNotMatter) {
  EXPECT_EQ(Decide({Car(20.0, 0.0, kSpeed + 1.0)}), Decision::kDrive) << "it drives away";
  EXPECT_EQ(Decide({At(150.0, 0.0, 1.0)}), Decision::kDrive) << "far away";
  EXPECT_EQ(Decide({At(-4.0, 0.0, 1.0)}), Decision::kDrive) << "passed";
  EXPECT_EQ(Decide({Car(-12.0, 0.0, kSpeed + 3.0)}), Decision::kDrive) << "it follows";
  EXPECT_NE(PlanAnew({At(-3.0, 2.5, 1.0)}).side[0], Side::kNone) << "beside it yet";
}

TEST_F(MovingTraffic, ObstacleThatMovesAheadAndCannotBePassedIsFollowed) {
  Obstacle slow = At(12.0, 0.0, 3.0);
  slow.velocity_X = 5.0;
  for (const double speed : {4.5, 5.0, 5.5}) {
    const Manoeuvre& manoeuvre = PlanAnew({slow}, 0.0, speed);
    EXPECT_EQ(manoeuvre.decision, Decision::kFollow) << speed;
    ASSERT_EQ(manoeuvre.stops().size(), 1u);
    EXPECT_NEAR(manoeuvre.stops()[0].speed, 5.0, 1e-9);
    const double gap = slow.X - 3.0 - (manoeuvre.stops()[0].s + 2.0);
    EXPECT_NEAR(gap, kSettings.stop_gap + kSettings.headway * 5.0, 1e-6);
  }
}

TEST_F(MovingTraffic, PedestrianIsPassedAtAGreaterDistanceThanAThing) {
  Obstacle person = At(40.0, -2.2, 0.3);
  const auto distance = [&] {
    const Manoeuvre& manoeuvre = PlanAnew({person});
    EXPECT_EQ(manoeuvre.side[0], Side::kLeft);
    return manoeuvre.path.At(kPlace + 40.0).offset - person.Y - person.r_y - kHalfWidth;
  };
  person.object_class = ObstacleClass::kStatic;
  EXPECT_NEAR(distance(), 1.0, 1e-3) << "the way along the middle of the road is 1 m off";
  person.object_class = ObstacleClass::kPedestrian;
  EXPECT_GE(distance(), 0.6 + 0.08 * kSpeed - 0.02);
}

TEST_F(NarrowRoad, WhereThereIsNoRoomForThatThePedestrianIsPassedMoreSlowly) {
  // 1.1 m of room for margins.
  Obstacle person = At(40.0, -1.7, 0.3);
  person.object_class = ObstacleClass::kStatic;
  EXPECT_NEAR(PlanAnew({person}).SpeedLimitAt(kPlace + 40.0), kSpeed, 0.1);
  person.object_class = ObstacleClass::kPedestrian;
  const Manoeuvre& manoeuvre = PlanAnew({person});
  EXPECT_EQ(manoeuvre.decision, Decision::kPass);
  EXPECT_LT(manoeuvre.SpeedLimitAt(kPlace + 40.0), 8.0);
  EXPECT_GT(manoeuvre.SpeedLimitAt(kPlace + 40.0), 2.0);
}

TEST_F(NarrowRoad, PedestrianWhoCrossesGoesFirst) {
  Obstacle person = At(40.0, -3.0, 0.3);
  person.velocity_Y = 1.0;  // in the middle of the road when the vehicle would be there
  person.object_class = ObstacleClass::kPedestrian;
  const Manoeuvre& manoeuvre = Plan({person});
  EXPECT_EQ(manoeuvre.decision, Decision::kYield);
  EXPECT_EQ(manoeuvre.reason, Reason::kCrossingFirst);
  EXPECT_EQ(manoeuvre.object, 1);
  ASSERT_FALSE(manoeuvre.stops().empty());
  EXPECT_LE(manoeuvre.stops()[0].s, person.X - 0.3 - 2.0 - kSettings.stop_gap + 1e-6);
}

TEST_F(TwoLanes, SlowVehicleIsOvertakenUnlessSomebodyComesTowardsIt) {
  EXPECT_EQ(SideOf(Car(25.0, 0.0, 5.0)), Side::kLeft);
  const Manoeuvre& manoeuvre = PlanAnew({Car(25.0, 0.0, 5.0), Car(90.0, 3.5, -12.0)});
  EXPECT_EQ(manoeuvre.decision, Decision::kFollow);
  EXPECT_EQ(manoeuvre.reason, Reason::kOncomingFirst);
  EXPECT_EQ(manoeuvre.object, 1);
}

TEST_F(TwoLanes, ReasonTellsWhetherOvertakingSavesTimeOrOnlyNeedsNoMore) {
  EXPECT_EQ(PlanAnew({Car(50.0, 0.0, 5.0)}).reason, Reason::kWayFree);
  EXPECT_EQ(PlanAnew({Car(20.0, 0.0, 5.0)}).reason, Reason::kStayingCosts);
}

TEST_F(TwoLanes, WayForWhichItIsLateIsGivenUpAfterAFewCyclesOnly) {
  const std::vector near{Car(10.0, 0.0, 8.0)};  // too near to change lanes behind it
  const Manoeuvre* manoeuvre = &Plan(near);
  EXPECT_EQ(manoeuvre->decision, Decision::kPass);
  EXPECT_EQ(manoeuvre->reason, Reason::kLateForNow);
  for (int k = 0; k < 5; ++k) manoeuvre = &Plan(near);
  EXPECT_EQ(manoeuvre->decision, Decision::kFollow);
  EXPECT_EQ(manoeuvre->reason, Reason::kTooLate);
}

TEST_F(TwoLanes, OvertakingWaitsUntilTheOncomingVehicleHasPassed) {
  RoadPosition vehicle{.s = kPlace, .speed = kSpeed};
  std::vector<Obstacle> traffic{Car(25.0, 0.0, 5.0), Car(110.0, 3.5, -12.0)};
  traffic[0].id = 1;
  traffic[1].id = 2;
  bool followed = false, passed_before_it = false;
  double t = 0.0;
  for (; t < 60.0 && vehicle.s < traffic[0].X + 20.0; t += kStep) {
    const Manoeuvre& manoeuvre = planner_.Plan(traffic, vehicle);
    const double oncoming = traffic[1].X - vehicle.s;
    if (oncoming > 4.0 && manoeuvre.decision == Decision::kFollow) followed = true;
    if (vehicle.s > traffic[0].X && oncoming > 0.0) passed_before_it = true;
    Drive(manoeuvre, vehicle);
    for (Obstacle& car : traffic) {
      car.X += car.velocity_X * kStep;
      const double along = car.X - vehicle.s;
      const bool beside = along > -2.3 - 2.2 && along < 2.0 + 2.2;
      ASSERT_FALSE(beside && std::abs(car.Y - vehicle.lateral) < 2.0 * kHalfWidth) << car.id << " at " << t;
    }
  }
  EXPECT_TRUE(followed);
  EXPECT_FALSE(passed_before_it);
  EXPECT_GE(vehicle.s, traffic[0].X + 20.0) << "it has overtaken in the end";
  EXPECT_NEAR(vehicle.lateral, 0.0, 0.5) << "and is back in its lane";
}

}  // namespace
}  // namespace control
