#include "control/traffic/corridor.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/narrowing.hpp"
#include "tests/control/roads.hpp"

namespace control {
namespace {

constexpr double kHalfWidth = 0.9;
constexpr double kSpeed = 10.0;
constexpr double kPlace = 50.0;
constexpr Stations kStationsAhead{.s_0 = kPlace, .spacing = 2.0};
constexpr double kTime = 8.0;

SpeedPlan Steady(double speed) {
  SpeedPlan plan;
  plan.count = kStations;
  for (std::size_t j = 0; j < kStations; ++j) {
    plan.v[j] = speed;
    plan.t[j] = static_cast<double>(j) * kStationsAhead.spacing / speed;
  }
  return plan;
}

// A straight road from −4 m to 4 m, on which a vehicle of 4.3 m by 1.8 m drives at 10 m/s, with 70 m planned.
class CorridorTest : public ::testing::Test {
 protected:
  static constexpr CorridorSettings kSettings{
      .footprint = {.front = 2.0, .rear = 2.3, .half_width = kHalfWidth}};

  static RoadObject Standing(double ahead, double lateral, double radius,
                             PassingSide side = PassingSide::kUnknown) {
    return {.s = kPlace + ahead,
            .lateral = lateral,
            .half_length = radius,
            .half_width = radius,
            .crosses = true,
            .side = side};
  }
  static RoadObject Car(double ahead, double lateral, double speed) {
    return {.s = kPlace + ahead, .lateral = lateral, .speed = speed, .half_length = 2.2, .half_width = 0.9};
  }

  Way Find(const std::vector<RoadObject>& objects, double lateral = 0.0, double speed = kSpeed,
           std::vector<Side> kept = {}, bool squeeze = false) {
    kept.resize(RoadObjects::kMost, Side::kNone);
    Way way;
    corridor_.Find(kStationsAhead, {.s = kPlace, .lateral = lateral, .speed = speed}, objects, kept,
                   Steady(speed), {.squeeze = squeeze, .waits = kTime}, way);
    return way;
  }
  Side SideOf(const RoadObject& object, double lateral = 0.0) { return Find({object}, lateral).side[0]; }

  RoadProfile profile_{testing::StraightRoad(500.0, kSpeed), RoadBounds{.left = 4.0, .right = -4.0}, {}};
  Corridor corridor_{kSettings, profile_};
};

TEST_F(CorridorTest, OnAFreeRoadItLeadsAlongTheReferencePathOrBackToIt) {
  const Way free = Find({});
  EXPECT_EQ(free.reached, kStations);
  for (const double lateral : free.lateral) EXPECT_NEAR(lateral, 0.0, 1e-6);
  const Way back = Find({}, 2.0);
  EXPECT_NEAR(back.lateral[1], 2.0, 0.9 + 0.3) << "the steepest way and a cell";
  EXPECT_NEAR(back.lateral[kStations - 1], 0.0, 0.3);
}

TEST_F(CorridorTest, PassesOnTheSideThatAsksForTheLeastShift) {
  EXPECT_EQ(SideOf(Standing(40.0, -0.5, 0.6)), Side::kLeft);
  EXPECT_EQ(SideOf(Standing(40.0, 0.5, 0.6)), Side::kRight);
  EXPECT_EQ(SideOf(Standing(40.0, -3.0, 0.6)), Side::kLeft);
  EXPECT_EQ(SideOf(Standing(10.0, 0.1, 0.6), 2.0), Side::kLeft) << "it is already there";
}

TEST_F(CorridorTest, StaysWithinItsGapsAndTheObjectsMargins) {
  const RoadObject object = Standing(40.0, -0.5, 0.6);
  const Way way = Find({object});
  ASSERT_EQ(way.reached, kStations);
  for (std::size_t j = 1; j < kStations; ++j) {
    EXPECT_GE(way.lateral[j], way.gap[j].lo - 1e-6);
    EXPECT_LE(way.lateral[j], way.gap[j].hi + 1e-6);
    // The vehicle covers the road from 2.3 m behind its centre to 2 m before it.
    const double ahead = object.s - kStationsAhead.At(j);
    if (ahead - 0.6 < 2.0 && ahead + 0.6 > -2.3) {
      EXPECT_GE(way.lateral[j] - object.lateral, 0.6 + kHalfWidth + 0.3 - 1e-6) << j;
    }
  }
}

TEST_F(CorridorTest, SideThatIsGivenIsObeyed) {
  EXPECT_EQ(SideOf(Standing(40.0, -0.5, 0.6, PassingSide::kRight)), Side::kRight);
  EXPECT_EQ(SideOf(Standing(40.0, 0.5, 0.6, PassingSide::kLeft)), Side::kLeft);
  const Way way = Find({Standing(40.0, -2.0, 1.5, PassingSide::kRight)});
  EXPECT_LT(way.reached, kStations) << "though the left is wide";
}

TEST_F(CorridorTest, EndsBeforeWhatLeavesNoGap) {
  // Beside a radius r in the middle there are 4 m − r; the vehicle needs 1.8 m and 0.15 m of margins.
  EXPECT_EQ(Find({Standing(40.0, 0.0, 2.0)}).reached, kStations);
  const Way way = Find({Standing(40.0, 0.0, 2.1)});
  ASSERT_LT(way.reached, kStations);
  const double front = kStationsAhead.At(way.reached - 1) + 2.0;
  EXPECT_LT(front, kPlace + 40.0 - 2.1);
  EXPECT_GT(front + kStationsAhead.spacing, kPlace + 40.0 - 2.1) << "the next station is beside it";
}

TEST_F(CorridorTest, SqueezingUsesTheMarginsUp) {
  const RoadObject object = Standing(40.0, 0.0, 2.12);  // 0.08 m more than the vehicle's width to either side
  EXPECT_LT(Find({object}).reached, kStations);
  EXPECT_EQ(Find({object}, 0.0, kSpeed, {}, true).reached, kStations);
  EXPECT_LT(Find({Standing(40.0, 0.0, 2.25)}, 0.0, kSpeed, {}, true).reached, kStations)
      << "the vehicle does not fit";
}

TEST_F(CorridorTest, SideIsKeptUnlessTheOtherIsMuchBetter) {
  ASSERT_EQ(SideOf(Standing(40.0, 0.1, 0.6)), Side::kRight);
  const Way kept = Find({Standing(40.0, 0.1, 0.6)}, 0.0, kSpeed, {Side::kLeft});
  EXPECT_EQ(kept.side[0], Side::kLeft);
  EXPECT_EQ(kept.changes, 0.0);
  const Way changed = Find({Standing(40.0, 2.0, 0.6)}, 0.0, kSpeed, {Side::kLeft});
  EXPECT_EQ(changed.side[0], Side::kRight) << "the left is closed";
  EXPECT_GT(changed.changes, 0.0);
}

TEST_F(CorridorTest, SlalomRoundTwoObjects) {
  const std::vector apart{Standing(20.0, 1.6, 1.5), Standing(55.0, -1.6, 1.5)};
  const Way way = Find(apart);
  ASSERT_EQ(way.reached, kStations);
  EXPECT_EQ(way.side[0], Side::kRight);
  EXPECT_EQ(way.side[1], Side::kLeft);
  EXPECT_LT(way.lateral[10], 1.6 - 1.5 - kHalfWidth);
  EXPECT_GT(way.lateral[27], -1.6 + 1.5 + kHalfWidth);
  const Way together = Find({Standing(40.0, 1.6, 1.5), Standing(45.0, -1.6, 1.5)});
  EXPECT_LT(together.reached, kStations) << "it cannot get from one gap to the other";
}

TEST_F(CorridorTest, ObjectsSideBySideArePassedInTheMiddle) {
  const Way way = Find({Standing(40.0, 2.5, 0.8), Standing(40.5, -2.5, 0.8)});
  EXPECT_EQ(way.reached, kStations);
  EXPECT_EQ(way.side[0], Side::kRight);
  EXPECT_EQ(way.side[1], Side::kLeft);
}

TEST_F(CorridorTest, OncomingObjectBlocksOnlyIfItIsMetBesideTheParkedOne) {
  // The parked one leaves 4.1 m on the left, the oncoming one takes 1.6 m to 3.4 m of it. Met at 10 m/s each, after
  // half of the distance.
  const RoadObject parked = Standing(30.0, -1.6, 1.5);
  EXPECT_LT(Find({parked, Car(60.0, 2.5, -10.0)}).reached, kStations);
  for (const double ahead : {20.0, 110.0}) {
    const Way way = Find({parked, Car(ahead, 2.5, -10.0)});
    EXPECT_EQ(way.reached, kStations) << ahead;
    EXPECT_EQ(way.side[0], Side::kLeft) << ahead;
    EXPECT_EQ(way.side[1], Side::kRight) << ahead;
  }
}

TEST_F(CorridorTest, ObjectThatCrossesIsJudgedWhereItIsMet) {
  RoadObject pedestrian = Standing(30.0, -2.0, 0.3);  // met after 3 s
  EXPECT_EQ(SideOf(pedestrian), Side::kLeft);
  pedestrian.drift = 1.0;  // then at 1 m
  EXPECT_EQ(SideOf(pedestrian), Side::kRight);
  pedestrian.drift = -1.0;
  EXPECT_EQ(SideOf(pedestrian), Side::kLeft);
}

TEST_F(CorridorTest, ObjectThatIsNotMetHasNoSide) {
  EXPECT_EQ(SideOf(Car(20.0, 0.0, kSpeed + 1.0)), Side::kNone) << "it drives away";
  EXPECT_EQ(SideOf(Car(40.0, 0.0, 5.0)), Side::kNone) << "it is caught up with after 70 m";
  EXPECT_NE(SideOf(Car(20.0, -2.0, 5.0)), Side::kNone);
}

TEST_F(CorridorTest, BesideAreTheObjectsThatOverlapTheVehicleOnTheWayFromOneStationToTheNext) {
  // From station 9 to 10, the vehicle covers 15.7 m to 22 m ahead of its present place.
  const std::vector objects{Standing(15.2, 0.0, 0.4), Standing(15.2, 0.0, 0.6), Standing(22.5, 0.0, 0.4),
                            Standing(22.5, 0.0, 0.6), Car(40.0, 0.0, -10.0)};
  const auto beside = corridor_.Beside(kStationsAhead, objects, Steady(kSpeed), 10);
  EXPECT_EQ(std::vector(beside.begin(), beside.end()), (std::vector<std::size_t>{1, 3, 4}));
}

TEST_F(CorridorTest, RoadThatNarrowsMovesTheWayAside) {
  const RoadProfile narrowing(testing::StraightRoad(500.0, kSpeed),
                              testing::NarrowingOnTheRight(kPlace + 20.0, kPlace + 40.0, 0.0), {});
  Corridor corridor(kSettings, narrowing);
  const std::array<Side, RoadObjects::kMost> kept{};
  Way way;
  corridor.Find(kStationsAhead, {.s = kPlace, .speed = kSpeed}, {}, kept, Steady(kSpeed), {.waits = kTime},
                way);
  ASSERT_EQ(way.reached, kStations);
  EXPECT_NEAR(way.lateral[4], 0.0, 1e-6);
  for (std::size_t j = 21; j < kStations; ++j) EXPECT_GE(way.lateral[j], kHalfWidth + 0.4 - 1e-6);
}

}  // namespace
}  // namespace control
