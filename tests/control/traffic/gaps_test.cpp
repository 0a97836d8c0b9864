#include "control/traffic/gaps.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

constexpr double kHalfWidth = 0.9;
constexpr Margin kRoadMargin{.least = 0.05, .wanted = 0.4};
constexpr Margin kMargin{.least = 0.1, .wanted = 0.3};
// 4 m to either side.
constexpr Covered kRoad{.right = 4.0, .left = -4.0, .margin = kRoadMargin};

std::vector<Gap> Find(std::vector<Covered> covered, const Covered& road = kRoad) {
  Gaps gaps;
  gaps.Find(road, covered, kHalfWidth);
  return {gaps.gaps().begin(), gaps.gaps().end()};
}

TEST(Gaps, FreeRoadIsOneGapWithoutALimitOfSpeed) {
  const auto gaps = Find({});
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_NEAR(gaps[0].lo, -4.0 + kHalfWidth + 0.4, 1e-12);
  EXPECT_NEAR(gaps[0].hi, 4.0 - kHalfWidth - 0.4, 1e-12);
  EXPECT_EQ(gaps[0].share, 1.0);
  EXPECT_TRUE(std::isinf(gaps[0].speed));
}

TEST(Gaps, ObjectSplitsTheRoadIntoGapsFromRightToLeft) {
  const auto gaps = Find({{.right = -0.5, .left = 0.5, .margin = kMargin}});
  ASSERT_EQ(gaps.size(), 2u);
  EXPECT_NEAR(gaps[0].lo, -4.0 + kHalfWidth + 0.4, 1e-12);
  EXPECT_NEAR(gaps[0].hi, -0.5 - kHalfWidth - 0.3, 1e-12);
  EXPECT_NEAR(gaps[1].lo, 0.5 + kHalfWidth + 0.3, 1e-12);
  EXPECT_NEAR(gaps[1].hi, 4.0 - kHalfWidth - 0.4, 1e-12);
}

TEST(Gaps, WhereTheMarginsDoNotFitTheyShrinkAlikeAndTheSpeedWithThem) {
  // Margins of 0.15 m at least and of 0.7 m as wanted; 0.425 m is half way.
  Covered object{.right = -9.0, .left = 4.0 - 2.0 * kHalfWidth - 0.425, .margin = kMargin};
  object.margin.speed = 20.0;
  const auto gaps = Find({object});
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_NEAR(gaps[0].share, 0.5, 1e-9);
  EXPECT_NEAR(gaps[0].lo, object.left + kHalfWidth + 0.2, 1e-9);
  EXPECT_NEAR(gaps[0].hi, 4.0 - kHalfWidth - 0.225, 1e-9);
  EXPECT_NEAR(gaps[0].speed, 11.0, 1e-6) << "half way from 2 m/s to 20 m/s";
}

TEST(Gaps, MarginsThatShrinkLeaveNoPlayButNeverLess) {
  testing::Random random(5);
  for (int k = 0; k < 1000; ++k) {
    const double room = random.Uniform(0.15, 0.7);
    const auto gaps = Find({{.right = -9.0, .left = 4.0 - 2.0 * kHalfWidth - room, .margin = kMargin}});
    ASSERT_EQ(gaps.size(), 1u);
    EXPECT_LE(gaps[0].lo, gaps[0].hi) << room;
    EXPECT_NEAR(gaps[0].lo, gaps[0].hi, 1e-12) << room;
  }
}

TEST(Gaps, GapExistsDownToTheLeastMargins) {
  const double edge = 4.0 - 2.0 * kHalfWidth - 0.15;
  const auto open = Find({{.right = -9.0, .left = edge - 1e-6, .margin = kMargin}});
  ASSERT_EQ(open.size(), 1u);
  EXPECT_NEAR(open[0].share, 0.0, 1e-5);
  EXPECT_NEAR(open[0].speed, 2.0, 1e-3) << "walking pace";
  EXPECT_TRUE(Find({{.right = -9.0, .left = edge + 1e-6, .margin = kMargin}}).empty());
}

TEST(Gaps, OverlappingAndNestedObjectsAreOne) {
  const Covered wide{.right = -1.0, .left = 1.0, .margin = kMargin};
  const Covered nested{.right = -0.9, .left = -0.8, .margin = kMargin};
  const Covered overlapping{.right = 0.5, .left = 1.5, .margin = kMargin};
  for (const auto& objects :
       {std::vector{wide, nested, overlapping}, std::vector{overlapping, nested, wide}}) {
    const auto gaps = Find(objects, {.right = 6.0, .left = -6.0, .margin = kRoadMargin});
    ASSERT_EQ(gaps.size(), 2u);
    EXPECT_NEAR(gaps[0].hi, -1.0 - kHalfWidth - 0.3, 1e-12);
    EXPECT_NEAR(gaps[1].lo, 1.5 + kHalfWidth + 0.3, 1e-12);
  }
}

// The wider margin of a pedestrian may shrink, but not so far that the vehicle would touch what is beside them.
TEST(Gaps, WhatIsBesideAPedestrianKeepsItsOwnMargin) {
  const Margin wide{.least = 0.5, .wanted = 2.0};
  const Covered pedestrian{.right = -0.5, .left = 0.0, .margin = wide};
  const Covered parked{.right = -0.5, .left = 1.0, .margin = kMargin};
  // Left of the parked one, there is 0.1 m more than the vehicle's width; margins are 0.15 m at least.
  EXPECT_TRUE(Find({pedestrian, parked}, {.right = 2.9, .left = -1.0, .margin = kRoadMargin}).empty());
  const Covered mirrored_pedestrian{.right = 0.0, .left = 0.5, .margin = wide};
  const Covered mirrored_parked{.right = -1.0, .left = 0.5, .margin = kMargin};
  EXPECT_TRUE(
      Find({mirrored_pedestrian, mirrored_parked}, {.right = 1.0, .left = -2.9, .margin = kRoadMargin})
          .empty());
}

TEST(Gaps, EveryGapKeepsTheLeastMarginsToEverything) {
  testing::Random random(7);
  int found = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Covered> objects(static_cast<std::size_t>(random.Integer(0, 5)));
    for (Covered& object : objects) {
      object.right = random.Uniform(-5.0, 4.0);
      object.left = object.right + random.Uniform(0.1, 2.0);
      object.margin.least = random.Uniform(0.0, 0.5);
      object.margin.wanted = object.margin.least + random.Uniform(0.0, 1.5);
    }
    double before = -1e9;
    for (const Gap& gap : Find(objects)) {
      ++found;
      EXPECT_LE(gap.lo, gap.hi + 1e-9);
      EXPECT_GT(gap.lo, before) << "from right to left";
      before = gap.hi;
      EXPECT_GE(gap.lo, -4.0 + kHalfWidth + kRoadMargin.least - 1e-9);
      EXPECT_LE(gap.hi, 4.0 - kHalfWidth - kRoadMargin.least + 1e-9);
      for (const Covered& o : objects) {
        EXPECT_TRUE(gap.lo - kHalfWidth - o.left > o.margin.least - 1e-9 ||
                    o.right - gap.hi - kHalfWidth > o.margin.least - 1e-9);
      }
    }
  }
  EXPECT_GT(found, 1000);
}

TEST(Gaps, AsManyAreKeptAsThereIsRoomFor) {
  std::vector<Covered> posts;
  for (int k = 0; k < 20; ++k) posts.push_back({.right = 3.0 * k, .left = 3.0 * k + 0.1, .margin = kMargin});
  EXPECT_EQ(Find(posts, {.right = 70.0, .left = -5.0, .margin = kRoadMargin}).size(), Gaps::kMost);
}

TEST(Margins, GrowWithTheSpeedAndWithHowVulnerableTheObjectIs) {
  for (const double speed : {5.0, 10.0, 20.0}) {
    const Margin wall = MarginTo(ObstacleClass::kStatic, speed, 0.3);
    const Margin cyclist = MarginTo(ObstacleClass::kCycle, speed, 0.3);
    const Margin pedestrian = MarginTo(ObstacleClass::kPedestrian, speed, 0.3);
    EXPECT_EQ(wall.wanted, 0.3);
    EXPECT_GT(cyclist.wanted, 1.0);
    EXPECT_GT(pedestrian.wanted, 0.9);
    EXPECT_GT(pedestrian.least, wall.least);
    for (const auto c : {ObstacleClass::kUnknown, ObstacleClass::kStatic, ObstacleClass::kVehicle,
                         ObstacleClass::kCycle, ObstacleClass::kPedestrian}) {
      const Margin here = MarginTo(c, speed, 0.3), faster = MarginTo(c, speed + 5.0, 0.3);
      EXPECT_LE(here.least, here.wanted);
      EXPECT_LE(here.wanted, faster.wanted);
    }
  }
}

}  // namespace
}  // namespace control
