#include "control/road/passing.hpp"

#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/roads.hpp"

namespace control {
namespace {

// A straight road in X direction from −4 m to 4 m, on which the vehicle of width 1.8 m is at X = 50 m.
class Passing : public ::testing::Test {
 protected:
  static constexpr double kSpeed = 12.0;
  static constexpr double kPlace = 50.0;
  static constexpr PassingSettings kSettings{.footprint = {.front = 2.0, .rear = 2.3, .half_width = 0.9},
                                             .margin = 0.3,
                                             .road_margin = 0.1,
                                             .grip = 5.0};

  // A circle `ahead` of the vehicle's centre and `Y` left of the middle of the road [m].
  static Obstacle At(double ahead, double Y, double radius, PassingSide side = PassingSide::kUnknown) {
    return {.X = kPlace + ahead, .Y = Y, .r_x = radius, .r_y = radius, .side = side};
  }
  std::vector<Passage> Decide(std::vector<Obstacle> obstacles, double lateral = 0.0, double speed = kSpeed) {
    int id = 0;
    for (Obstacle& obstacle : obstacles) obstacle.id = ++id;
    std::vector<Passage> passages;
    for (const PassingDecision& decision : planner_.Decide(obstacles, kPlace, lateral, speed)) {
      passages.push_back(decision.passage);
    }
    return passages;
  }
  Passage Decide(const Obstacle& obstacle, double lateral = 0.0, double speed = kSpeed) {
    return Decide(std::vector{obstacle}, lateral, speed).front();
  }
  Passage DecideAnew(const Obstacle& obstacle, double lateral = 0.0, double speed = kSpeed) {
    planner_.Reset();
    return Decide(obstacle, lateral, speed);
  }

  RoadProfile profile_{testing::StraightRoad(300.0, kSpeed), {.left = 4.0, .right = -4.0}, {}};
  PassingPlanner planner_{kSettings, profile_};
};

TEST_F(Passing, OfTwoWideGapsThatOneIsTakenThatAsksForTheLeastShift) {
  EXPECT_EQ(DecideAnew(At(40.0, -0.5, 0.6)), Passage::kLeft);
  EXPECT_EQ(DecideAnew(At(40.0, 0.5, 0.6)), Passage::kRight);
  EXPECT_EQ(DecideAnew(At(40.0, -3.0, 0.6)), Passage::kLeft) << "it need not shift at all";
  EXPECT_EQ(DecideAnew(At(40.0, 0.1, 0.6), 2.0), Passage::kLeft) << "it is already there";
}

TEST_F(Passing, SideThatIsGivenIsObeyed) {
  EXPECT_EQ(DecideAnew(At(40.0, -0.5, 0.6, PassingSide::kRight)), Passage::kRight);
  EXPECT_EQ(DecideAnew(At(40.0, 0.5, 0.6, PassingSide::kLeft)), Passage::kLeft);
  EXPECT_EQ(DecideAnew(At(40.0, -2.0, 1.5, PassingSide::kRight)), Passage::kStop)
      << "though the left is wide";
}

TEST_F(Passing, WhereNoGapIsWideEnoughItStops) {
  // Room between obstacle and road edge, each with its margin: 4 − 0.1 − (2 + 0.3) = 1.6 m < 1.8 m.
  EXPECT_EQ(DecideAnew(At(40.0, 0.0, 2.0)), Passage::kStop);
  EXPECT_NE(DecideAnew(At(40.0, 0.0, 1.75)), Passage::kStop);
  EXPECT_EQ(DecideAnew(At(40.0, 0.25, 2.0)), Passage::kRight);
}

TEST_F(Passing, ObstaclesSideBySideArePassedInTheMiddle) {
  const auto passages = Decide({At(40.0, 2.5, 0.8), At(40.5, -2.5, 0.8)});
  EXPECT_EQ(passages[0], Passage::kRight);
  EXPECT_EQ(passages[1], Passage::kLeft);
}

TEST_F(Passing, ObstaclesBetweenWhichItDoesNotFitArePassedAsOne) {
  // Each alone would be passed on its free side, but the vehicle cannot get from one gap to the other.
  const auto together = Decide({At(40.0, 1.6, 1.5), At(45.0, -1.6, 1.5)});
  EXPECT_EQ(together[0], Passage::kStop);
  EXPECT_EQ(together[1], Passage::kStop);
  planner_.Reset();
  const auto apart = Decide({At(40.0, 1.6, 1.5), At(75.0, -1.6, 1.5)});
  EXPECT_EQ(apart[0], Passage::kRight);
  EXPECT_EQ(apart[1], Passage::kLeft);
}

TEST_F(Passing, LongObstacleBelongsToWhatItBeginsBeside) {
  const Obstacle closes_left = At(20.0, 1.6, 1.5);
  const Obstacle harmless = At(32.0, -3.5, 0.3);
  Obstacle closes_right = At(38.0, -1.6, 1.5);
  EXPECT_EQ(Decide({closes_left, harmless, closes_right})[0], Passage::kRight);
  closes_right.r_x = 15.0;  // begins 1.5 m behind the first
  planner_.Reset();
  for (const Passage passage : Decide({closes_left, harmless, closes_right}))
    EXPECT_EQ(passage, Passage::kStop);
}

TEST_F(Passing, DecisionIsKeptWhileItCanBe) {
  for (const Passage first : {Passage::kLeft, Passage::kRight}) {
    planner_.Reset();
    const double sign = first == Passage::kLeft ? -1.0 : 1.0;
    ASSERT_EQ(Decide(At(40.0, 0.2 * sign, 0.6)), first);
    for (int k = 0; k < 20; ++k) {
      const Obstacle noisy = At(40.0, (k % 2 == 0 ? -0.1 : 0.1), 0.6);
      EXPECT_EQ(Decide(noisy), first);
    }
    // The decision changes where the other side is much better.
    EXPECT_NE(Decide(At(40.0, -1.0 * sign, 0.6)), first);
  }
  EXPECT_NE(DecideAnew(At(40.0, -0.1, 0.6)), DecideAnew(At(40.0, 0.1, 0.6))) << "noise would turn the wheel";
}

TEST_F(Passing, ObstacleThatMovesIsJudgedWhereItIsMet) {
  Obstacle crossing = At(38.6, -3.0, 0.6);  // its near end is 36 m ahead of the front: met in 3 s
  EXPECT_EQ(DecideAnew(crossing), Passage::kLeft);
  crossing.velocity_Y = 1.5;  // then at Y = 1.5 m
  EXPECT_EQ(DecideAnew(crossing), Passage::kRight);
  crossing.velocity_Y = 3.0;  // then off the road on the other side
  EXPECT_EQ(DecideAnew(crossing), Passage::kRight);

  // An obstacle that moves ahead is met later.
  Obstacle slow = At(38.6, -3.0, 0.6);
  slow.velocity_X = 8.0;  // met in 9 s: does not matter yet
  slow.velocity_Y = 0.4;
  EXPECT_EQ(DecideAnew(slow), Passage::kIgnored);
  slow.velocity_X = 7.0;  // met in 7.2 s at Y = −0.12 m
  EXPECT_EQ(DecideAnew(slow), Passage::kLeft);
  slow.velocity_X = 6.5;  // met in 6.5 s at Y = −0.38 m
  slow.velocity_Y = 0.6;  // at Y = 0.93 m
  EXPECT_EQ(DecideAnew(slow), Passage::kRight);
}

TEST_F(Passing, ObstacleThatIsNotMetIsIgnored) {
  Obstacle away = At(20.0, 0.0, 1.0);
  away.velocity_X = kSpeed + 1.0;
  EXPECT_EQ(DecideAnew(away), Passage::kIgnored);
  EXPECT_EQ(DecideAnew(At(150.0, 0.0, 1.0)), Passage::kIgnored) << "far away";
  EXPECT_EQ(DecideAnew(At(-4.0, 0.0, 1.0)), Passage::kIgnored) << "passed";
  EXPECT_NE(DecideAnew(At(-3.0, 2.5, 1.0)), Passage::kIgnored) << "beside it yet";
}

TEST_F(Passing, ObstacleThatIsFollowedAtItsOwnSpeedIsNotIgnored) {
  Obstacle slow = At(8.0, 0.0, 2.0);
  slow.velocity_X = 5.0;
  for (const double speed : {4.5, 5.0, 5.5}) EXPECT_EQ(Decide(slow, 0.0, speed), Passage::kStop) << speed;
}

TEST_F(Passing, WhereItIsTooLateToStopAGapIsTakenThatLeavesTheMarginsNoRoom) {
  const Obstacle tight = At(8.0, -0.5, 2.6);  // the gap lacks 0.3 m of the margins' 0.4 m
  EXPECT_EQ(DecideAnew(tight, 0.0, kSpeed), Passage::kLeft);
  EXPECT_EQ(DecideAnew(tight, 0.0, 3.0), Passage::kStop);
  Obstacle other = tight;
  other.Y = 0.5;
  EXPECT_EQ(DecideAnew(other, 0.0, kSpeed), Passage::kRight);
}

TEST_F(Passing, WhereTheVehicleDoesNotFitItBrakesThoughItIsTooLate) {
  EXPECT_EQ(DecideAnew(At(8.0, -0.5, 3.5), 0.0, kSpeed), Passage::kStop);
}

TEST_F(Passing, AtStandstillItStaysBeforeABlockedRoadThoughSomethingIsBesideIt) {
  for (const double speed : {0.0, 0.02, 0.5}) {
    planner_.Reset();
    for (const Passage passage : Decide({At(0.5, -2.5, 0.5), At(8.0, 0.0, 3.0)}, 0.0, speed)) {
      EXPECT_EQ(passage, Passage::kStop);
    }
  }
}

TEST_F(Passing, ShiftThatNeedsMoreThanTheGripIsStoppedForWhileThatIsPossible) {
  constexpr double kSlow = 6.0;
  const auto fork = [](double ahead) {
    return At(ahead, -0.8, 2.5);
  };  // a shift of 2.9 m to the left; the right is closed
  EXPECT_EQ(DecideAnew(fork(30.0), 0.0, kSlow), Passage::kLeft);
  EXPECT_EQ(DecideAnew(fork(10.0), 0.0, kSlow), Passage::kStop);
  EXPECT_EQ(DecideAnew(fork(8.0), 0.0, kSlow), Passage::kLeft) << "too late";
}

TEST_F(Passing, DecisionGivesWhereTheObstacleIsOnTheRoad) {
  Obstacle obstacle = At(40.0, 0.0, 1.0);
  obstacle.r_y = 2.0;
  obstacle.heading = M_PI / 2.0;
  obstacle.velocity_X = 4.0;
  const auto decisions = planner_.Decide({&obstacle, 1}, kPlace, 0.0, kSpeed);
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_NEAR(decisions[0].s, 90.0, 1e-9);
  EXPECT_NEAR(decisions[0].speed, 4.0, 1e-12);
  EXPECT_NEAR(decisions[0].half_length, 2.0, 1e-12);
}

TEST_F(Passing, ObstaclesBeyondTheMostGetNoDecision) {
  const std::vector<Obstacle> many(PassingPlanner::kMostObstacles + 3, At(40.0, -2.0, 0.5));
  EXPECT_EQ(planner_.Decide(many, kPlace, 0.0, kSpeed).size(), PassingPlanner::kMostObstacles);
}

}  // namespace
}  // namespace control
