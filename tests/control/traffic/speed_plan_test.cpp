#include "control/traffic/speed_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

constexpr SpeedLimits kLimits{.acceleration = 1.5, .deceleration = 2.0, .emergency = 5.0};
constexpr double kForever = 1e3;

StationValues Everywhere(double value) {
  StationValues values;
  values.fill(value);
  return values;
}

TEST(SpeedPlan, SpeedsUpAsFastAsTheAccelerationAllows) {
  const Stations stations{.s_0 = 30.0, .spacing = 2.0};
  const SpeedPlan plan = PlanSpeed(stations, Everywhere(30.0), {}, 10.0, kLimits, kForever);
  ASSERT_EQ(plan.count, kStations);
  for (std::size_t j = 0; j < kStations; ++j) {
    const double v = std::sqrt(100.0 + 2.0 * 1.5 * (stations.At(j) - 30.0));
    EXPECT_NEAR(plan.v[j], v, 1e-9);
    EXPECT_NEAR(plan.t[j], (v - 10.0) / 1.5, 1e-9);
  }
  EXPECT_EQ(plan.excess, 0.0);
}

TEST(SpeedPlan, BrakesInTimeForALowerLimit) {
  const Stations stations{.spacing = 2.0};
  StationValues allowed = Everywhere(12.0);
  for (std::size_t j = 25; j < kStations; ++j) allowed[j] = 4.0;
  const SpeedPlan plan = PlanSpeed(stations, allowed, {}, 12.0, kLimits, kForever);
  ASSERT_EQ(plan.count, kStations);
  for (std::size_t j = 0; j < 25; ++j) {
    const double v = std::min(12.0, std::sqrt(16.0 + 2.0 * 2.0 * (stations.At(25) - stations.At(j))));
    EXPECT_NEAR(plan.v[j], v, 1e-9);
  }
  EXPECT_NEAR(plan.v[25], 4.0, 1e-9);
  EXPECT_EQ(plan.excess, 0.0);
}

TEST(SpeedPlan, WhereALimitComesTooLateItBrakesHardAndTellsTheExcess) {
  const SpeedPlan plan = PlanSpeed({.spacing = 1.0}, Everywhere(5.0), {}, 20.0, kLimits, kForever);
  EXPECT_NEAR(plan.v[1], std::sqrt(400.0 - 2.0 * 5.0), 1e-9);
  EXPECT_NEAR(plan.excess, std::sqrt(390.0) - 5.0, 1e-9);
}

TEST(SpeedPlan, ReachesOnlyTheStationsWithinTheTime) {
  const SpeedPlan plan = PlanSpeed({.spacing = 1.0}, Everywhere(10.0), {}, 10.0, kLimits, 2.05);
  EXPECT_EQ(plan.count, 21u);
  EXPECT_NEAR(plan.t[20], 2.0, 1e-9);
}

// It stands at the line, which is between two stations: the last one reached is the first that is not before the line.
TEST(SpeedPlan, StopsAtALineAndWaitsThere) {
  const Stations stations{.spacing = 2.0};
  for (const double s : {50.5, 51.0, 51.5}) {
    const StopLine line{.s = s};
    const SpeedPlan plan = PlanSpeed(stations, Everywhere(12.0), {&line, 1}, 12.0, kLimits, kForever);
    ASSERT_EQ(plan.count, 27u) << "52 m";
    for (std::size_t j = 0; j < 26; ++j) {
      EXPECT_LE(plan.v[j] * plan.v[j], 2.0 * kLimits.deceleration * (line.s - stations.At(j)) + 1e-9);
      EXPECT_GT(plan.v[j], 0.0);
    }
    EXPECT_EQ(plan.v[26], 0.0);
    EXPECT_EQ(plan.excess, 0.0);
  }
}

TEST(SpeedPlan, TheNearestOfTheLinesCounts) {
  const StopLine near{.s = 41.0}, far{.s = 60.0};
  const SpeedPlan alone = PlanSpeed({.spacing = 2.0}, Everywhere(12.0), {&near, 1}, 12.0, kLimits, kForever);
  for (const auto& lines : {std::vector{near, far}, std::vector{far, near}}) {
    const SpeedPlan both = PlanSpeed({.spacing = 2.0}, Everywhere(12.0), lines, 12.0, kLimits, kForever);
    EXPECT_EQ(both.count, alone.count);
    EXPECT_EQ(both.v, alone.v);
  }
}

TEST(SpeedPlan, BehindALineThatMovesItTakesOnItsSpeed) {
  const Stations stations{.spacing = 4.0};
  const StopLine line{.s = 30.0, .speed = 5.0};
  const SpeedPlan plan = PlanSpeed(stations, Everywhere(12.0), {&line, 1}, 12.0, kLimits, kForever);
  ASSERT_EQ(plan.count, kStations);
  for (std::size_t j = 0; j < kStations; ++j) EXPECT_LE(stations.At(j), line.s + line.speed * plan.t[j]);
  EXPECT_NEAR(plan.v[kStations - 1], 5.0, 0.2);
}

TEST(SpeedPlan, BeyondALineTheVehicleFallsBack) {
  const StopLine line{.s = 60.0, .speed = 5.0};
  const double at_line = SpeedBefore({&line, 1}, 70.0, 2.0, 2.0, 4.0);
  const double beyond = SpeedBefore({&line, 1}, 72.0, 2.0, 2.0, 4.0);
  EXPECT_NEAR(at_line, 5.0, 1e-9);
  EXPECT_LT(beyond, 5.0);
  EXPECT_GT(beyond, 0.0);
  EXPECT_EQ(SpeedBefore({&line, 1}, 200.0, 2.0, 2.0, 4.0), 0.0) << "never backwards";
  const StopLine standing{.s = 60.0};
  EXPECT_EQ(SpeedBefore({&standing, 1}, 60.1, 0.0, 2.0, 4.0), 0.0);
  EXPECT_TRUE(std::isinf(SpeedBefore({}, 0.0, 0.0, 2.0, 4.0)));
}

TEST(SpeedPlan, StandsWhereItMayNotDrive) {
  EXPECT_EQ(PlanSpeed({}, Everywhere(0.0), {}, 0.0, kLimits, kForever).count, 1u);
  EXPECT_EQ(PlanSpeed({}, Everywhere(0.0), {}, -0.3, kLimits, kForever).v[0], 0.0);
}

TEST(SpeedPlan, KeepsTheLimitsOfAccelerationAndTimeGoesOnWithTheDistance) {
  testing::Random random(3);
  for (int trial = 0; trial < 500; ++trial) {
    const Stations stations{.s_0 = random.Uniform(-10.0, 90.0), .spacing = random.Uniform(0.5, 5.0)};
    StationValues allowed;
    for (double& limit : allowed) limit = random.Uniform(1.0, 25.0);
    std::vector<StopLine> lines(static_cast<std::size_t>(random.Integer(0, 3)));
    for (StopLine& line : lines) {
      line = {.s = stations.s_0 + random.Uniform(5.0, 100.0), .speed = random.Uniform(0.0, 10.0)};
    }
    const SpeedPlan plan = PlanSpeed(stations, allowed, lines, random.Uniform(0.0, 25.0), kLimits, 8.0);
    for (std::size_t j = 0; j + 1 < plan.count; ++j) {
      const double v = plan.v[j], next = plan.v[j + 1], dt = plan.t[j + 1] - plan.t[j];
      EXPECT_GE(next, 0.0);
      EXPECT_GT(dt, 0.0);
      EXPECT_NEAR(0.5 * (v + next) * dt, stations.spacing, 1e-9);
      EXPECT_LE((next - v) / dt, kLimits.acceleration + 1e-9);
      EXPECT_GE((next - v) / dt, -kLimits.emergency - 1e-9);
      EXPECT_LE(next, allowed[j + 1] + plan.excess + 1e-9);
      EXPECT_LE(plan.t[j + 1], 8.0);
    }
  }
}

}  // namespace
}  // namespace control
