#include "control/traffic/path_smoother.hpp"

#include <algorithm>
#include <cmath>

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

constexpr double kSpeed = 10.0;
constexpr double kSpacing = 2.0;
constexpr Stations kPlaces{.s_0 = 50.0, .spacing = kSpacing};
constexpr double kTouch = 1e-5;

SpeedPlan Steady() {
  SpeedPlan plan;
  plan.count = kStations;
  for (std::size_t j = 0; j < kStations; ++j) {
    plan.v[j] = kSpeed;
    plan.t[j] = static_cast<double>(j) * kSpacing / kSpeed;
  }
  return plan;
}

// A way as wide as the road.
Way Free(std::size_t reached = kStations) {
  Way way;
  way.reached = reached;
  way.gap.fill({.lo = -3.0, .hi = 3.0});
  return way;
}

// A way to the left of `lo` from station 12 to station 18.
Way RoundAnObject(double lo) {
  Way way = Free();
  for (std::size_t j = 12; j <= 18; ++j) way.gap[j].lo = lo;
  return way;
}

LateralPath Smooth(const LateralPoint& start, const Way& way, const PathSmootherSettings& settings = {},
                   double curvature = 0.0) {
  StationValues curvatures;
  curvatures.fill(curvature);
  LateralPath path;
  EXPECT_TRUE(PathSmoother(settings).Smooth(kPlaces, start, way, Steady(), curvatures, path));
  EXPECT_TRUE(path.exists);
  return path;
}

// As the header states it.
double Cost(const LateralPath& path, const PathSmootherSettings& settings = {}) {
  double cost = 0.0;
  for (std::size_t j = 0; j < kStations; ++j) {
    const double yaw_rate = kSpeed * path.bend[j];
    cost += kSpacing / kSpeed *
            (path.offset[j] * path.offset[j] + settings.heading_weight * path.slope[j] * path.slope[j] +
             settings.yaw_rate_weight * yaw_rate * yaw_rate);
  }
  return cost;
}

// The path with these bends from the same start.
LateralPath WithBends(const LateralPath& path, const StationValues& bend) {
  LateralPath changed = path;
  changed.bend = bend;
  for (std::size_t j = 0; j + 1 < kStations; ++j) {
    changed.offset[j + 1] =
        changed.offset[j] + kSpacing * changed.slope[j] + 0.5 * kSpacing * kSpacing * changed.bend[j];
    changed.slope[j + 1] = changed.slope[j] + kSpacing * changed.bend[j];
  }
  return changed;
}

bool Within(const LateralPath& path, const Way& way, double tolerance) {
  for (std::size_t j = 1; j < way.reached; ++j) {
    if (path.offset[j] < way.gap[j].lo - tolerance || path.offset[j] > way.gap[j].hi + tolerance)
      return false;
  }
  return true;
}

TEST(PathSmoother, OnTheReferencePathItStaysThere) {
  const LateralPath path = Smooth({}, Free());
  for (std::size_t j = 0; j < kStations; ++j) {
    EXPECT_NEAR(path.offset[j], 0.0, 1e-9);
    EXPECT_NEAR(path.bend[j], 0.0, 1e-9);
  }
}

TEST(PathSmoother, BeginsAtTheStartAndComesBackToTheReferencePath) {
  const LateralPath path = Smooth({.offset = 1.5, .slope = 0.05}, Free());
  EXPECT_NEAR(path.offset[0], 1.5, 1e-12);
  EXPECT_NEAR(path.slope[0], 0.05, 1e-12);
  EXPECT_LT(std::abs(path.offset[kStations - 1]), 0.2);
}

TEST(PathSmoother, IsContinuousWithItsSlope) {
  const LateralPath path = Smooth({.offset = -0.5}, RoundAnObject(1.2));
  const LateralPath integrated = WithBends(path, path.bend);
  for (std::size_t j = 0; j < kStations; ++j) {
    EXPECT_NEAR(path.offset[j], integrated.offset[j], 1e-9);
    EXPECT_NEAR(path.slope[j], integrated.slope[j], 1e-9);
  }
}

TEST(PathSmoother, StaysWithinTheGapsAndNoFartherFromTheReferencePathThanTheyAsk) {
  for (const double lo : {0.5, 1.2, 2.0}) {
    const Way way = RoundAnObject(lo);
    const LateralPath path = Smooth({}, way);
    EXPECT_TRUE(Within(path, way, kTouch)) << lo;
    // The gap of station 12 holds from station 11 on.
    EXPECT_GE(path.offset[11], lo - kTouch);
    EXPECT_LT(*std::ranges::max_element(path.offset), lo + 0.5);
  }
}

TEST(PathSmoother, IsFreeBehindTheStationsThatTheWayReaches) {
  Way way = RoundAnObject(1.2);
  way.reached = 12;
  const LateralPath path = Smooth({}, way);
  for (const double offset : path.offset) EXPECT_NEAR(offset, 0.0, 1e-9);
}

TEST(PathSmoother, BetweenGapsThatDoNotOverlapEachStationHasItsOwn) {
  Way way = Free();
  for (std::size_t j = 15; j < 25; ++j) way.gap[j] = {.lo = j < 20 ? -2.0 : 0.1, .hi = j < 20 ? -0.1 : 2.0};
  EXPECT_TRUE(Within(Smooth({}, way), way, 1e-3));
}

TEST(PathSmoother, KeepsTheLargestCurvatureOfRoadAndPathTogether) {
  const PathSmootherSettings settings{.max_curvature = 0.02};
  for (const double road : {0.0, 0.015, -0.015}) {
    const LateralPath path = Smooth({.offset = 2.0}, RoundAnObject(2.5), settings, road);
    for (std::size_t j = 0; j + 1 < kStations; ++j) EXPECT_LE(std::abs(road + path.bend[j]), 0.02 + 1e-6);
  }
}

TEST(PathSmoother, NoSmallChangeOfTheBendsIsBetter) {
  const LateralPath path = Smooth({.offset = 1.0, .slope = -0.02}, Free());
  const double best = Cost(path);
  testing::Random random(5);
  for (int trial = 0; trial < 300; ++trial) {
    StationValues bend = path.bend;
    const double size = std::pow(10.0, random.Uniform(-6.0, -3.0));
    for (std::size_t j = 0; j + 1 < kStations; ++j) bend[j] += random.Uniform(-size, size);
    EXPECT_GT(Cost(WithBends(path, bend)), best - 1e-9);
  }
}

TEST(PathSmoother, NoWayTowardsAnotherPathWithinTheGapsIsBetter) {
  const Way way = RoundAnObject(1.2);
  const LateralPath path = Smooth({}, way);
  const double best = Cost(path);
  for (const double heading_weight : {0.1, 3.0, 100.0}) {
    for (const double yaw_rate_weight : {0.5, 10.0, 400.0}) {
      const LateralPath other =
          Smooth({}, way, {.heading_weight = heading_weight, .yaw_rate_weight = yaw_rate_weight});
      ASSERT_TRUE(Within(other, way, kTouch));
      ASSERT_GT(Cost(other), best);
      for (const double share : {0.5, 0.1, 0.01, 0.001}) {
        StationValues bend;
        for (std::size_t j = 0; j < kStations; ++j)
          bend[j] = path.bend[j] + share * (other.bend[j] - path.bend[j]);
        EXPECT_GT(Cost(WithBends(path, bend)), best - 1e-6) << share;
      }
    }
  }
}

TEST(PathSmoother, WhereNothingIsSolvedThePathIsUnchanged) {
  LateralPath path = Smooth({.offset = 1.0}, Free());
  const LateralPath before = path;
  EXPECT_FALSE(PathSmoother({}).Smooth(kPlaces, {.offset = std::nan("")}, Free(), Steady(), {}, path));
  EXPECT_EQ(path.offset, before.offset);
}

}  // namespace
}  // namespace control
