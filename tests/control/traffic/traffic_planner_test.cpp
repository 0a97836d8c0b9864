#include "control/traffic/traffic_planner.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "control/traffic/speed_plan.hpp"
#include "gtest/gtest.h"
#include "tests/control/narrowing.hpp"
#include "tests/control/random.hpp"
#include "tests/control/traffic/planned_traffic.hpp"

namespace control {
namespace {

using testing::Random;
using TrafficPlannerTest = testing::PlannedTraffic;

TEST_F(TrafficPlannerTest, OnAFreeRoadItDrivesAlongTheReferencePath) {
  const Manoeuvre& manoeuvre = Plan({});
  EXPECT_EQ(manoeuvre.decision, Decision::kDrive);
  EXPECT_EQ(manoeuvre.reason, Reason::kWayFree);
  EXPECT_EQ(manoeuvre.object, -1);
  EXPECT_TRUE(manoeuvre.stops().empty());
  for (const double ahead : {0.0, 20.0, 60.0}) {
    EXPECT_NEAR(manoeuvre.path.At(kPlace + ahead).offset, 0.0, 1e-6);
    EXPECT_NEAR(manoeuvre.SpeedLimitAt(kPlace + ahead), kSpeed, 1e-6);
  }
}

TEST_F(TrafficPlannerTest, OfTwoWideGapsThatOneIsTakenThatAsksForTheLeastShift) {
  EXPECT_EQ(SideOf(At(40.0, -0.5, 0.6)), Side::kLeft);
  EXPECT_EQ(SideOf(At(40.0, 0.5, 0.6)), Side::kRight);
  EXPECT_EQ(SideOf(At(40.0, -3.0, 0.6)), Side::kLeft) << "it need not shift at all";
  EXPECT_EQ(SideOf(At(15.0, 0.1, 0.6), 2.0), Side::kLeft) << "it is already there";
}

TEST_F(TrafficPlannerTest, PathKeepsTheMarginBesideTheObstacle) {
  const Manoeuvre& manoeuvre = Plan({At(40.0, -0.5, 0.6)});
  ASSERT_EQ(manoeuvre.decision, Decision::kPass);
  EXPECT_EQ(manoeuvre.reason, Reason::kWayFree);
  EXPECT_EQ(manoeuvre.object, 1);
  EXPECT_EQ(manoeuvre.passed, Side::kLeft);
  EXPECT_TRUE(manoeuvre.stops().empty());
  // From where the vehicle's front reaches the obstacle to where its rear leaves it.
  for (double ahead = 40.0 - 0.6 - 2.0; ahead < 40.0 + 0.6 + 2.3; ahead += 0.5) {
    EXPECT_GE(manoeuvre.path.At(kPlace + ahead).offset, -0.5 + 0.6 + kHalfWidth + 0.3 - 0.02) << ahead;
  }
}

TEST_F(TrafficPlannerTest, SideThatIsGivenIsObeyed) {
  EXPECT_EQ(SideOf(At(40.0, -0.5, 0.6, PassingSide::kRight)), Side::kRight);
  EXPECT_EQ(SideOf(At(40.0, 0.5, 0.6, PassingSide::kLeft)), Side::kLeft);
  EXPECT_EQ(Decide({At(40.0, -2.0, 1.5, PassingSide::kRight)}), Decision::kWait) << "though the left is wide";
}

TEST_F(TrafficPlannerTest, WhereNoGapIsWideEnoughItWaitsBeforeTheObstacle) {
  // Beside a radius r in the middle there are 4 m − r; the vehicle needs 1.8 m and 0.15 m of margins.
  EXPECT_EQ(Decide({At(40.0, 0.0, 2.0)}), Decision::kPass);
  EXPECT_EQ(Decide({At(40.0, 0.25, 2.1)}), Decision::kPass);
  const Manoeuvre& manoeuvre = PlanAnew({At(40.0, 0.0, 2.1)});
  EXPECT_EQ(manoeuvre.decision, Decision::kWait);
  EXPECT_EQ(manoeuvre.reason, Reason::kNoGap);
  EXPECT_EQ(manoeuvre.object, 1);
  EXPECT_EQ(manoeuvre.passed, Side::kNone);
  ASSERT_EQ(manoeuvre.stops().size(), 1u);
  EXPECT_EQ(manoeuvre.stops()[0].speed, 0.0);
  EXPECT_NEAR(manoeuvre.stops()[0].s, kPlace + 40.0 - 2.1 - 2.0 - kSettings.stop_gap, 1e-6);
}

class NarrowingRoad : public testing::PlannedTraffic {
 protected:
  NarrowingRoad() : PlannedTraffic(testing::NarrowingOnTheRight(kPlace + 60.0, kPlace + 80.0, 2.5)) {}
};

TEST_F(NarrowingRoad, WhereTheRoadItselfIsTooNarrowItWaitsForNothing) {
  const Manoeuvre& manoeuvre = Plan({});
  EXPECT_EQ(manoeuvre.decision, Decision::kWait);
  EXPECT_EQ(manoeuvre.reason, Reason::kRoadTooNarrow);
  EXPECT_EQ(manoeuvre.object, -1);
  ASSERT_FALSE(manoeuvre.stops().empty());
}

TEST_F(TrafficPlannerTest, ObstaclesSideBySideArePassedInTheMiddle) {
  const Manoeuvre& manoeuvre = Plan({At(40.0, 2.5, 0.8), At(40.5, -2.5, 0.8)});
  EXPECT_EQ(manoeuvre.decision, Decision::kPass);
  EXPECT_EQ(manoeuvre.side[0], Side::kRight);
  EXPECT_EQ(manoeuvre.side[1], Side::kLeft);
}

TEST_F(TrafficPlannerTest, ObstaclesBetweenWhichItDoesNotFitAreNotPassed) {
  EXPECT_EQ(Decide({At(40.0, 1.6, 1.5), At(45.0, -1.6, 1.5)}), Decision::kWait);
  const Manoeuvre& apart = PlanAnew({At(40.0, 1.6, 1.5), At(75.0, -1.6, 1.5)});
  EXPECT_EQ(apart.decision, Decision::kPass);
  EXPECT_EQ(apart.side[0], Side::kRight);
  EXPECT_EQ(apart.side[1], Side::kLeft);
}

TEST_F(TrafficPlannerTest, LongObstacleCountsFromItsNearEnd) {
  const Obstacle closes_left = At(30.0, 1.6, 1.5);
  Obstacle closes_right = At(65.0, -1.6, 1.5);
  EXPECT_EQ(Decide({closes_left, closes_right}), Decision::kPass);
  closes_right.r_x = 32.0;
  closes_right.shape = ObstacleShape::kBox;
  EXPECT_EQ(Decide({closes_left, closes_right}), Decision::kWait);
}

TEST_F(TrafficPlannerTest, DecisionIsKeptInSpiteOfNoise) {
  for (const Side first : {Side::kLeft, Side::kRight}) {
    const double sign = first == Side::kLeft ? -1.0 : 1.0;
    ASSERT_EQ(PlanAnew({At(40.0, 0.2 * sign, 0.6)}).side[0], first);
    for (int k = 0; k < 20; ++k) {
      EXPECT_EQ(Plan({At(40.0, (k % 2 == 0 ? -0.1 : 0.1), 0.6)}).side[0], first);
    }
    EXPECT_NE(Plan({At(40.0, -2.0 * sign, 0.6)}).side[0], first) << "its side is closed";
  }
  EXPECT_NE(SideOf(At(40.0, -0.1, 0.6)), SideOf(At(40.0, 0.1, 0.6))) << "noise would turn the wheel";
}

TEST_F(TrafficPlannerTest, WhereItIsTooLateToStopAGapIsTakenThatLeavesTheMarginsNoRoom) {
  // 0.1 m more than the vehicle's width on one side; from 12 m/s, it takes 14 m to stop.
  Obstacle tight = At(14.0, -0.5, 2.6);
  const Manoeuvre& left = PlanAnew({tight});
  EXPECT_EQ(left.decision, Decision::kSqueeze);
  EXPECT_EQ(left.reason, Reason::kTooLateToStop);
  EXPECT_EQ(left.side[0], Side::kLeft);
  EXPECT_EQ(left.passed, Side::kLeft);
  EXPECT_TRUE(left.stops().empty());
  EXPECT_EQ(Decide({tight}, 0.0, 3.0), Decision::kWait);
  tight.Y = 0.5;
  const Manoeuvre& right = PlanAnew({tight});
  EXPECT_EQ(right.decision, Decision::kSqueeze);
  EXPECT_EQ(right.side[0], Side::kRight);
}

TEST_F(TrafficPlannerTest, WhereTheVehicleDoesNotFitItBrakesThoughItIsTooLate) {
  const Manoeuvre& manoeuvre = Plan({At(8.0, -0.5, 3.5)});
  EXPECT_EQ(manoeuvre.decision, Decision::kSqueeze);
  EXPECT_EQ(manoeuvre.reason, Reason::kNoWay);
  ASSERT_FALSE(manoeuvre.stops().empty());
  EXPECT_LT(manoeuvre.stops()[0].s, kPlace + 8.0 - 3.5);
}

TEST_F(TrafficPlannerTest, AtStandstillItStaysBeforeABlockedRoadThoughSomethingIsBesideIt) {
  for (const double speed : {0.0, 0.02, 0.5}) {
    const Manoeuvre& manoeuvre = PlanAnew({At(0.5, -2.5, 0.5), At(8.0, 0.0, 3.0)}, 0.0, speed);
    EXPECT_EQ(manoeuvre.decision, Decision::kWait) << speed;
    ASSERT_FALSE(manoeuvre.stops().empty());
    EXPECT_EQ(manoeuvre.object, 2);
    EXPECT_NEAR(manoeuvre.stops()[0].s, kPlace + 8.0 - 3.0 - 2.0 - kSettings.stop_gap, 1e-6);
  }
}

TEST_F(TrafficPlannerTest, RoadThatWasBlockedAndIsFreeAgainIsDrivenOn) {
  const std::vector wall{At(20.0, 0.0, 3.0)};
  for (int k = 0; k < 10; ++k) ASSERT_EQ(Plan(wall, 0.0, 0.0).decision, Decision::kWait);
  for (int k = 0; k < 10; ++k) static_cast<void>(Plan({}, 0.0, 0.0));
  EXPECT_EQ(Plan({}, 0.0, 0.0).decision, Decision::kDrive);
  EXPECT_TRUE(Plan({}, 0.0, 0.0).stops().empty());
  for (int k = 0; k < 10; ++k) ASSERT_EQ(Plan(wall, 0.0, 0.0).decision, Decision::kWait);
  const std::vector aside{At(20.0, 2.5, 1.0)};
  for (int k = 0; k < 10; ++k) static_cast<void>(Plan(aside, 0.0, 0.0));
  EXPECT_EQ(Plan(aside, 0.0, 0.0).decision, Decision::kPass) << "it has moved aside";
}

TEST_F(TrafficPlannerTest, ObstacleThatIsSeenForOneCycleLessDoesNotReopenTheRoad) {
  const std::vector wall{At(20.0, 0.0, 3.0)};
  for (int k = 0; k < 5; ++k) ASSERT_EQ(Plan(wall, 0.0, 0.0).decision, Decision::kWait);
  std::vector gap{At(20.0, 0.0, 2.0)};  // noise of its size
  EXPECT_EQ(Plan(gap, 0.0, 0.0).decision, Decision::kWait);
  EXPECT_EQ(Plan(gap, 0.0, 0.0).reason, Reason::kOpenTooShort);
  EXPECT_EQ(Plan(wall, 0.0, 0.0).decision, Decision::kWait);
  EXPECT_EQ(Plan(wall, 0.0, 0.0).reason, Reason::kNoGap);
}

TEST_F(TrafficPlannerTest, NarrowGapLimitsTheSpeedToWhatItsMarginsAreWorth) {
  // The left is given. It has 0.2 m of room for margins of 0.15 m at least and of 0.4 m as wanted at 40 m/s: a fifth
  // of the way from walking pace.
  const Manoeuvre& manoeuvre = Plan({At(40.0, 0.0, 2.0, PassingSide::kLeft)});
  ASSERT_EQ(manoeuvre.decision, Decision::kPass);
  EXPECT_LE(manoeuvre.SpeedLimitAt(kPlace + 40.0), 2.0 + 0.2 * 38.0 + 1e-6);
  const Manoeuvre& wide = PlanAnew({At(40.0, 0.0, 1.5, PassingSide::kLeft)});
  EXPECT_GT(wide.SpeedLimitAt(kPlace + 40.0), 2.0 + 0.2 * 38.0 + 1.0);
}

TEST_F(TrafficPlannerTest, ManoeuvreGivesWhereTheObstacleIsOnTheRoad) {
  Obstacle obstacle = At(40.0, 0.0, 1.0);
  obstacle.r_y = 2.0;
  obstacle.heading = M_PI / 2.0;
  obstacle.velocity_X = 4.0;
  const Manoeuvre& manoeuvre = Plan({obstacle});
  ASSERT_EQ(manoeuvre.objects.size(), 1u);
  EXPECT_NEAR(manoeuvre.objects[0].s, 90.0, 1e-9);
  EXPECT_NEAR(manoeuvre.objects[0].speed, 4.0, 1e-12);
  EXPECT_NEAR(manoeuvre.objects[0].half_length, 2.0, 1e-12);
}

TEST_F(TrafficPlannerTest, ObstaclesBeyondTheMostAreCounted) {
  const std::vector<Obstacle> many(RoadObjects::kMost + 3, At(40.0, -2.0, 0.5));
  const Manoeuvre& manoeuvre = Plan(many);
  EXPECT_EQ(manoeuvre.objects.size(), RoadObjects::kMost);
  EXPECT_EQ(manoeuvre.left_out, 3u);
  EXPECT_EQ(Plan({}).left_out, 0u);
}

// What a corner may cut between the places at which the planner looks [m].
constexpr double kBetween = 0.05;

// For 4 s, which is twice what the controller looks ahead, or up to the first stop line.
TEST_F(TrafficPlannerTest, AmongThingsThatStandItsPathTouchesNothing) {
  constexpr double kTime = 4.0;
  Random random(11);
  int passed = 0, waited = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<Obstacle> things(static_cast<std::size_t>(random.Integer(1, 5)));
    for (Obstacle& thing : things) {
      thing = At(random.Uniform(30.0, 60.0), random.Uniform(-4.0, 4.0), random.Uniform(0.3, 2.0));
    }
    const Manoeuvre& manoeuvre = PlanAnew(things);
    ASSERT_NE(manoeuvre.decision, Decision::kSqueeze) << "there are 26 m to stop";
    if (manoeuvre.decision == Decision::kPass) ++passed;
    if (manoeuvre.decision == Decision::kWait) ++waited;
    const SpeedPlan speeds = PlanSpeed(manoeuvre.path.stations, manoeuvre.speed_limit, manoeuvre.stops(),
                                       kSpeed, profile_.limits(), kTime);
    double end = manoeuvre.path.stations.At(speeds.count - 1);
    for (const StopLine& stop : manoeuvre.stops()) end = std::min(end, stop.s);
    for (double s = kPlace; s < end; s += 0.25) {
      const double offset = manoeuvre.path.At(s).offset;
      EXPECT_LE(std::abs(offset), 4.0 - kHalfWidth);
      for (const Obstacle& thing : obstacles_) {
        if (thing.X - thing.r_x > s + 2.0 || thing.X + thing.r_x < s - 2.3) continue;
        EXPECT_GT(std::abs(offset - thing.Y), thing.r_y + kHalfWidth - kBetween)
            << "trial " << trial << ", object " << thing.id << ", s = " << s;
      }
    }
  }
  EXPECT_GT(passed, 100);
  EXPECT_GT(waited, 100);
}

}  // namespace
}  // namespace control
