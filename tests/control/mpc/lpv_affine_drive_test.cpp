// LpvAffineMpc in closed loop with the nonlinear model.
#include <algorithm>
#include <cmath>

#include "control/mpc/lpv_affine_mpc.hpp"
#include "gtest/gtest.h"
#include "tests/control/mpc/road_loop.hpp"
#include "tests/control/narrowing.hpp"
#include "tests/control/roads.hpp"

namespace control {
namespace {

using testing::RoadLoop;
using testing::StraightRoad;
using testing::WindingRoad;

// Figures of one drive.
struct Figures {
  int not_solved = 0;
  double largest_lateral = 0.0;
  double clearance = 1e300;
  double road_margin = 1e300;
  double largest_acceleration_across = 0.0;
  double least_speed = 1e300;
};

// Drives for `seconds`, or until `done()` or a failed step.
template <typename Done>
Figures Drive(RoadLoop& loop, double seconds, Done done) {
  Figures figures;
  for (int k = 0; k * loop.settings().t_s < seconds && !done(); ++k) {
    const Plan& plan = loop.Ask();
    if (plan.status != SolverStatus::kSolved) {
      ++figures.not_solved;
      break;
    }
    loop.Drive(plan);
    figures.largest_lateral = std::max(figures.largest_lateral, std::abs(loop.lateral()));
    figures.clearance = std::min(figures.clearance, loop.Clearance());
    figures.road_margin = std::min(figures.road_margin, loop.RoadMargin());
    figures.largest_acceleration_across =
        std::max(figures.largest_acceleration_across, std::abs(loop.z()[kUpsilon] * loop.z()[kOmega]));
    figures.least_speed = std::min(figures.least_speed, loop.z()[kUpsilon]);
  }
  return figures;
}

Figures Drive(RoadLoop& loop, double seconds) {
  return Drive(loop, seconds, [] { return false; });
}

// Lateral offset and speed error that a lasting disturbance leaves on a straight road at 25 m/s.
Eigen::Vector2d OffsetOf(const Disturbance& acts, const Disturbance& told) {
  RoadLoop loop(StraightRoad(600.0, 25.0));
  loop.Disturb(acts, told);
  EXPECT_EQ(Drive(loop, 15.0).not_solved, 0);
  return {loop.lateral(), loop.z()[kUpsilon] - 25.0};
}

TEST(LpvAffineDrive, DisturbanceLeavesNoOffsetIfTheControllerIsToldOfIt) {
  const Disturbance offset{.delta_0 = 0.0175};
  EXPECT_GT(std::abs(OffsetOf(offset, {}).x()), 0.3);
  EXPECT_LT(std::abs(OffsetOf(offset, offset).x()), 1e-3);
  const Disturbance bank{.a_y = -1.0};
  EXPECT_GT(std::abs(OffsetOf(bank, {}).x()), 0.05);
  EXPECT_LT(std::abs(OffsetOf(bank, bank).x()), 1e-3);
  const Disturbance slope{.a_x = -1.0};
  EXPECT_LT(OffsetOf(slope, {}).y(), -0.3);
  EXPECT_NEAR(OffsetOf(slope, slope).y(), 0.0, 1e-2);
}

TEST(LpvAffineDrive, PlanKeepsToTheFrictionThatIsFelt) {
  RoadLoop loop(StraightRoad(600.0, 25.0));
  loop.PlaceAt(0.0, 10.0);
  const auto most = [&](double mu_limit) {
    loop.mpc().Reset();
    ControllerInput input = loop.Asked();
    input.mu_limit = mu_limit;
    const Plan& plan = loop.mpc().Step(input);
    EXPECT_EQ(plan.status, SolverStatus::kSolved);
    double a = 0.0;
    for (const Input& u : plan.u) a = std::max(a, u[kAcceleration]);
    return a;
  };
  EXPECT_GT(most(kNoLimit), 1.2);
  EXPECT_GT(most(2.0), 1.2);  // no more than configured
  EXPECT_LT(most(0.05), 0.9 * 0.05 * kGravity + 0.01);
}

TEST(LpvAffineDrive, KeepsCloseToAWindingRoadAtTheSpeedOfItsCurves) {
  RoadLoop loop(WindingRoad(25.0, 14.0));
  const Figures figures = Drive(loop, 60.0, [&] { return loop.s() > 220.0; });
  EXPECT_EQ(figures.not_solved, 0);
  EXPECT_GE(loop.s(), 220.0);
  EXPECT_LT(figures.largest_lateral, 0.15);
  EXPECT_LT(figures.largest_acceleration_across, 3.3);
  EXPECT_GT(figures.least_speed, 7.5);
}

TEST(LpvAffineDrive, StopsAtTheEndOfTheCourseAndHolds) {
  RoadLoop loop(StraightRoad(80.0, 12.0));
  EXPECT_EQ(Drive(loop, 14.0).not_solved, 0);
  EXPECT_NEAR(loop.s(), 80.0, 0.5);
  EXPECT_LT(loop.z()[kUpsilon], 0.05);
  const State held = loop.z();
  EXPECT_EQ(Drive(loop, 5.0).not_solved, 0);
  EXPECT_LT((loop.z() - held).head<2>().norm(), 0.1);
  EXPECT_NEAR(loop.u()[kAcceleration], -1.0, 1e-9);
}

TEST(LpvAffineDrive, SetsOffFromStandstill) {
  RoadLoop loop(StraightRoad(200.0, 10.0));
  loop.PlaceAt(0.0, 0.0, 0.5);
  const Figures figures = Drive(loop, 12.0);
  EXPECT_EQ(figures.not_solved, 0);
  EXPECT_NEAR(loop.z()[kUpsilon], 10.0, 0.6);
  EXPECT_LT(std::abs(loop.lateral()), 0.05);
  EXPECT_LT(figures.largest_lateral, 0.55);
}

TEST(LpvAffineDrive, ComesBackFromFarBesideTheCourse) {
  for (const double lateral : {3.0, -3.0}) {
    RoadLoop loop(StraightRoad(300.0, 12.0));
    loop.PlaceAt(10.0, 12.0, lateral);
    const Figures figures = Drive(loop, 6.0);
    EXPECT_EQ(figures.not_solved, 0);
    EXPECT_LT(std::abs(loop.lateral()), 0.1);
    EXPECT_LT(figures.largest_lateral, 3.2);
  }
}

class AnObstacle : public ::testing::TestWithParam<double> {};

TEST_P(AnObstacle, IsPassedByTheWholeFootprintOnTheRoad) {
  for (const double place : {60.0, 85.0, 110.0, 140.0}) {
    RoadLoop loop(WindingRoad(40.0, 12.0));
    loop.obstacles() = {loop.ObstacleAt(place, GetParam(), 0.8)};
    const Figures figures = Drive(loop, 40.0, [&] { return loop.s() > place + 30.0; });
    EXPECT_EQ(figures.not_solved, 0) << place;
    EXPECT_GT(loop.s(), place + 29.0) << "it went on";
    EXPECT_GT(figures.clearance, 0.2) << place;
    EXPECT_GT(figures.road_margin, 0.1) << place;
    EXPECT_GT(figures.least_speed, 5.0) << place;
    EXPECT_LT(std::abs(loop.lateral()), 0.2) << place;
  }
}

INSTANTIATE_TEST_SUITE_P(LpvAffineDrive, AnObstacle, ::testing::Values(-1.5, -0.3, 0.3, 1.5));

TEST(LpvAffineDrive, BeforeABlockedRoadItStopsHoldsAndGoesOnWhenItIsFree) {
  RoadLoop loop(StraightRoad(300.0, 12.0));
  loop.obstacles() = {loop.ObstacleAt(100.0, 0.0, 3.0)};
  Figures figures = Drive(loop, 15.0);
  EXPECT_EQ(figures.not_solved, 0);
  EXPECT_LT(std::abs(loop.z()[kUpsilon]), 0.05);
  EXPECT_NEAR(figures.clearance, loop.settings().stop_gap, 0.5);
  const double place = loop.s();
  figures = Drive(loop, 10.0);
  EXPECT_EQ(figures.not_solved, 0);
  EXPECT_NEAR(loop.s(), place, 0.1);
  loop.obstacles().clear();
  figures = Drive(loop, 8.0);
  EXPECT_EQ(figures.not_solved, 0);
  EXPECT_GT(loop.s(), place + 30.0);
}

TEST(LpvAffineDrive, ObstacleThatCrossesIsPassed) {
  for (const double speed : {1.0, -1.0}) {
    RoadLoop loop(StraightRoad(200.0, 12.0));
    Obstacle crossing = loop.ObstacleAt(60.0, -5.0 * speed, 0.5);
    crossing.velocity_Y = speed;
    loop.obstacles() = {crossing};
    const Figures figures = Drive(loop, 8.0);
    EXPECT_EQ(figures.not_solved, 0);
    EXPECT_GT(figures.clearance, 0.2);
    EXPECT_GT(figures.road_margin, 0.1);
    EXPECT_GT(loop.s(), 80.0);
  }
}

TEST(LpvAffineDrive, WhereTheRoadNarrowsTheVehicleGivesWay) {
  // The right edge comes as near as 0.5 m to the road's middle: half the vehicle's width and the margin need 1.0 m.
  for (const Route& route : {StraightRoad(200.0, 12.0), WindingRoad(40.0, 10.0)}) {
    RoadLoop loop(route, {}, testing::NarrowingOnTheRight(60.0, 90.0, -0.5));
    const Figures figures = Drive(loop, 60.0, [&] { return loop.s() > 150.0; });
    EXPECT_EQ(figures.not_solved, 0);
    EXPECT_GE(loop.s(), 150.0);
    EXPECT_GT(figures.road_margin, 0.05);
    EXPECT_LT(figures.largest_lateral, 1.0);
  }
}

TEST(LpvAffineDrive, SlowerVehicleThatCannotBePassedIsFollowed) {
  RoadLoop loop(StraightRoad(400.0, 12.0), {}, RoadBounds{.left = 2.0, .right = -2.0});
  Obstacle slow = loop.ObstacleAt(40.0, 0.0, 1.0);
  slow.velocity_X = 5.0;
  loop.obstacles() = {slow};
  Figures figures = Drive(loop, 15.0);
  EXPECT_EQ(figures.not_solved, 0);
  EXPECT_GT(figures.clearance, 1.0);
  figures = Drive(loop, 10.0);
  EXPECT_EQ(figures.not_solved, 0);
  EXPECT_GT(figures.clearance, 1.0);
  EXPECT_LT(loop.Clearance(), 8.0);
  EXPECT_NEAR(loop.z()[kUpsilon], 5.0, 1.0);
}

TEST(LpvAffineDrive, ObstacleThatAppearsLateIsAvoided) {
  for (const double lateral : {-0.6, 0.6}) {
    RoadLoop loop(StraightRoad(200.0, 12.0));
    Drive(loop, 1.0);
    loop.obstacles() = {loop.ObstacleAt(loop.s() + 18.0, lateral, 0.6)};
    const Figures figures = Drive(loop, 4.0);
    EXPECT_EQ(figures.not_solved, 0);
    EXPECT_GT(figures.clearance, 0.0);
    EXPECT_GT(figures.road_margin, 0.0);
  }
}

TEST(LpvAffineDrive, NearARoadBlockThatAppearsItBrakesAsHardAsItMay) {
  RoadLoop loop(StraightRoad(200.0, 12.0));
  Drive(loop, 1.0);
  loop.obstacles() = {loop.ObstacleAt(loop.s() + 24.0, 0.0, 3.0)};  // 19 m ahead of the front
  const Figures figures = Drive(loop, 8.0);
  EXPECT_EQ(figures.not_solved, 0);
  EXPECT_LT(std::abs(loop.z()[kUpsilon]), 0.1);
  EXPECT_GT(figures.clearance, 0.2);
}

}  // namespace
}  // namespace control
