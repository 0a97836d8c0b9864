#include "control/mpc/tracking_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "gtest/gtest.h"
#include "tests/control/narrowing.hpp"
#include "tests/control/roads.hpp"

namespace control {
namespace {

using Eigen::Vector2d;
const LpvAffineSettings kSettings;  // the vehicle from −2.3 m to 1.95 m, 1.8 m wide

State At(double X, double Y, double upsilon, double psi = 0.0) {
  return State{X, Y, upsilon, 0.0, psi, 0.0};
}

// A road in X direction from −4 m to 4 m.
class TrackingProblemTest : public ::testing::Test {
 protected:
  static Obstacle Circle(int id, double X, double Y, double radius) {
    return {.id = id, .X = X, .Y = Y, .r_x = radius, .r_y = radius};
  }
  // The states of a vehicle that keeps its velocity, from X = 50 m.
  static std::vector<State> Straight(double speed) {
    std::vector<State> z;
    for (int i = 0; i <= kSettings.horizon; ++i) z.push_back(At(50.0 + 0.05 * i * speed, 0.0, speed));
    return z;
  }
  // The rows of step i after those of the road, of which there are always two.
  std::span<const BodyRow> ObstacleRows(std::size_t i) const { return tracking_.rows(i).subspan(2); }

  RoadProfile profile_{testing::StraightRoad(400.0, 12.0), {}, {}};
  TrackingProblem tracking_{{}, profile_, kSettings};
};

TEST_F(TrackingProblemTest, StatusTellsTheDecisionWithTheDistanceToItsStopLineAndTheSpeedLimit) {
  tracking_.Begin(At(50.0, 0.0, 10.0), 50.0, {});
  EXPECT_EQ(tracking_.manoeuvre_status().decision, Decision::kDrive);
  EXPECT_TRUE(std::isinf(tracking_.manoeuvre_status().stop_distance));
  EXPECT_NEAR(tracking_.manoeuvre_status().speed_limit, 12.0, 1e-9);
  const std::vector wall{Circle(7, 90.0, 0.0, 3.5)};
  tracking_.Begin(At(50.0, 0.0, 10.0), 50.0, wall);
  const ManoeuvreStatus waits = tracking_.manoeuvre_status();
  EXPECT_EQ(waits.decision, Decision::kWait);
  EXPECT_EQ(waits.reason, Reason::kNoGap);
  EXPECT_EQ(waits.object, 7);
  EXPECT_EQ(waits.side, Side::kNone);
  EXPECT_NEAR(waits.stop_distance, 40.0 - 3.5 - kSettings.footprint.front - kSettings.stop_gap, 1e-6);
}

TEST_F(TrackingProblemTest, RoadRowsHoldTheEndsOfTheVehicleWithinTheEdgesOfABend) {
  const double radius = 30.0;
  const RoadProfile bend(testing::CircularRoad(radius, 1.6, 8.0), RoadBounds{.left = 3.0, .right = -5.0}, {});
  TrackingProblem tracking({}, bend, kSettings);
  const double turned = 2.5 * std::numbers::pi;  // the road's heading; the measured one is within π of 0
  tracking.Begin(At(radius, radius, 8.0, turned - 2.0 * std::numbers::pi), radius * turned, {});
  EXPECT_NEAR(tracking.z()[kPsi], turned, 1e-12);
  EXPECT_LT((Position(tracking.reference()[0]) - Position(bend.At(radius * turned))).norm(), 0.05);
  std::vector<State> z_hat(2, tracking.z());
  z_hat[1] += At(0.6, 0.5, 0.0, 0.1);
  tracking.BuildConstraints(z_hat);
  ASSERT_EQ(tracking.rows(1).size(), 2U);
  EXPECT_EQ(tracking.rows(1)[0].fixed, Vector2d(1.95, 0.0));
  EXPECT_EQ(tracking.rows(1)[1].fixed, Vector2d(-2.3, 0.0));
  const double inside = kSettings.footprint.half_width + kSettings.road_margin;
  for (const BodyRow& row : tracking.rows(1)) {
    const Vector2d p = Position(z_hat[1]) + Rotate(z_hat[1][kPsi], row.fixed);
    const double lateral = radius - (p - Vector2d(0.0, radius)).norm();  // left of the road
    EXPECT_NEAR(row.hi - row.normal.dot(p), 3.0 - inside - lateral, 0.01) << row.constraint.index;
    EXPECT_NEAR(row.normal.dot(p) - row.lo, lateral + 5.0 - inside, 0.01) << row.constraint.index;
  }
}

TEST_F(TrackingProblemTest, EachEndIsHeldWithinTheWidthOfTheRoadBesideIt) {
  // The road narrows by 0.1 m per metre while the vehicle is in the narrowing.
  const RoadEdges edges = testing::NarrowingOnTheRight(45.0, 75.0, -1.0);
  const RoadProfile profile(testing::StraightRoad(400.0, 12.0), edges, {});
  TrackingProblem tracking({}, profile, kSettings);
  const std::vector<State> z_hat = Straight(12.0);
  tracking.Begin(z_hat[0], 50.0, {});
  tracking.BuildConstraints(z_hat);
  const double inside = kSettings.footprint.half_width + kSettings.road_margin;
  for (std::size_t i = 1; i < z_hat.size(); ++i) {
    ASSERT_EQ(tracking.rows(i).size(), 2U);
    for (const BodyRow& row : tracking.rows(i)) {
      const double s = z_hat[i][kX] + row.fixed.x();
      EXPECT_NEAR(row.lo, -4.0 + 0.1 * std::clamp(s - 45.0, 0.0, 30.0) + inside, 1e-9) << i;
      EXPECT_NEAR(row.hi, 4.0 - inside, 1e-9) << i;
    }
  }
}

TEST_F(TrackingProblemTest, OnABendAnEndsPlaceIsThatOfItsProjection) {
  // On the inside of the bend, 20 m from its centre, the front is 1.95 m ahead along the tangent, 2.9 m along the road.
  const double radius = 30.0, s = 60.0;
  const RoadEdges edges(
      std::array{RoadSample{.s = 0.0, .bounds = {.left = 30.0, .right = -30.0}},
                 RoadSample{.s = 30.0 * 1.9 * std::numbers::pi, .bounds = {.left = 12.0, .right = -30.0}}});
  const RoadProfile bend(testing::CircularRoad(radius, 1.0, 8.0), edges, {});
  TrackingProblem tracking({}, bend, kSettings);
  const RoutePoint point = bend.At(s);
  const Vector2d place = Beside(point, 10.0);
  const std::vector<State> z_hat(2, At(place.x(), place.y(), 8.0, point.psi));
  tracking.Begin(z_hat[0], s, {});
  tracking.BuildConstraints(z_hat);
  for (const BodyRow& row : tracking.rows(1)) {
    const Vector2d end = Position(z_hat[1]) + Rotate(z_hat[1][kPsi], row.fixed);
    const RoadBounds there = bend.RoadAt(bend.Project(end, s).s);
    EXPECT_NEAR(row.hi - row.lo,
                there.left - there.right - 2.0 * (kSettings.footprint.half_width + kSettings.road_margin),
                0.01);
  }
}

TEST_F(TrackingProblemTest, ObstacleRowsKeepTheNearestCornersOutOfWhereItWillBe) {
  Obstacle obstacle = Circle(9, 62.0, -1.5, 0.6);  // there is room on its left only
  obstacle.velocity_X = 2.0;
  const std::vector<State> z_hat = Straight(12.0);
  tracking_.Begin(z_hat[0], 50.0, {&obstacle, 1});
  tracking_.BuildConstraints(z_hat);
  const double radius = 0.6 + kSettings.obstacle_margin;
  for (std::size_t i = 1; i < z_hat.size(); ++i) {
    const Vector2d centre(62.0 + 2.0 * kSettings.t_s * static_cast<double>(i), -1.5);
    const double ahead = centre.x() - z_hat[i][kX], reach = 0.5 * 0.6 + kSettings.obstacle_margin;
    const bool beside = ahead < 1.95 + radius + reach && ahead > -2.3 - radius - reach;
    const auto rows = ObstacleRows(i);
    ASSERT_EQ(rows.size(), beside ? 2U : 0U) << i;
    EXPECT_TRUE(!beside || rows[0].fixed != rows[1].fixed) << i;
    for (const BodyRow& row : rows) {
      EXPECT_GT(row.normal.y(), 0.5) << i;
      EXPECT_NEAR(row.lo, row.normal.dot(centre) + radius, 1e-9) << i;
      EXPECT_EQ(row.constraint.index, 9);
      EXPECT_EQ(row.constraint.step, static_cast<int>(i));
      const auto no_nearer = [&](const Vector2d& corner) {
        return row.normal.dot(corner - row.fixed) > -1e-12;
      };
      EXPECT_GE(std::ranges::count_if(kSettings.footprint.Corners(), no_nearer), 3) << i;
    }
  }
}

TEST_F(TrackingProblemTest, OfObstaclesThatBlockTheRoadOnlyTheFirstHasRowsAndTheReferenceEndsBeforeIt) {
  const std::array obstacles{Circle(2, 80.0, 0.0, 3.5), Circle(1, 60.0, 0.0, 3.5)};
  tracking_.Begin(At(50.0, 0.0, 3.0), 50.0, obstacles);
  tracking_.BuildConstraints(Straight(3.0));
  const double near_end = 60.0 - 3.5;
  for (std::size_t i = 1; i < tracking_.reference().size(); ++i) {
    ASSERT_EQ(ObstacleRows(i).size(), 2U) << i;
    for (const BodyRow& row : ObstacleRows(i)) {
      EXPECT_EQ(row.constraint.index, 1);
      EXPECT_EQ(row.fixed.x(), 1.95);
      EXPECT_LT((row.normal - Vector2d(-1.0, 0.0)).norm(), 1e-12) << "it stays on the near side";
      EXPECT_NEAR(row.lo, -(near_end - kSettings.obstacle_margin), 1e-9);
    }
    EXPECT_LE(tracking_.reference()[i][kX], near_end - kSettings.stop_gap - 1.95) << i;
  }
}

TEST_F(TrackingProblemTest, BeforeABlockedRoadItWaitsDespiteNoiseUntilTheRoadIsFree) {
  const std::array blocked{Circle(1, 50.1 + 1.95 + kSettings.stop_gap + 3.5, 0.0, 3.5)};
  const auto waits = [&](double upsilon, std::span<const Obstacle> obstacles) {
    tracking_.Begin(At(50.0, 0.0, upsilon), 50.0, obstacles);
    return tracking_.waiting();
  };
  EXPECT_FALSE(waits(0.2, blocked)) << "it still rolls";
  EXPECT_TRUE(waits(0.0, blocked));
  EXPECT_TRUE(waits(0.2, blocked));
  tracking_.Reset();
  EXPECT_FALSE(waits(0.2, blocked)) << "what it did before is forgotten";
  EXPECT_TRUE(waits(0.0, blocked));
  EXPECT_FALSE(waits(0.0, {}));
}

TEST_F(TrackingProblemTest, WaitingVehicleStaysWhereItIsWithTheBrakeAppliedAtItsRate) {
  tracking_.Begin(At(50.0, 0.3, 0.1, 0.02), 50.0, {});
  std::vector<State> states(4);
  std::vector<Input> inputs(3);
  tracking_.Hold({0.1, 1.5}, states, inputs);
  for (const State& z : states) EXPECT_LT((z - At(50.0, 0.3, 0.0, 0.02)).norm(), 1e-12);
  EXPECT_EQ(inputs, (std::vector<Input>{{0.1, 0.5}, {0.1, -0.5}, {0.1, -1.0}}));
  tracking_.Hold({0.1, -2.5}, states, inputs);
  EXPECT_EQ(inputs, (std::vector<Input>{{0.1, -1.5}, {0.1, -1.0}, {0.1, -1.0}}));
}

TEST_F(TrackingProblemTest, WaitingVehicleBrakesMoreThanTheSlopePullsAndMoreStillOnceItHasRolled) {
  const Obstacle wall{.id = 1, .X = 54.5, .Y = 0.0, .r_x = 0.5, .r_y = 5.0};
  std::vector<State> states(4);
  std::vector<Input> inputs(60);
  const auto brake = [&](double upsilon, double a_x) {
    tracking_.Begin(At(50.0, 0.0, upsilon), 50.0, {&wall, 1}, {.a_x = a_x});
    EXPECT_TRUE(tracking_.waiting());
    tracking_.Hold({0.0, 0.0}, states, inputs);
    return -inputs.back()[kAcceleration];
  };
  EXPECT_DOUBLE_EQ(brake(0.0, -2.0), 3.0);
  EXPECT_DOUBLE_EQ(brake(0.0, 2.0), 3.0);
  EXPECT_DOUBLE_EQ(brake(-0.2, 0.0), 3.0);
  EXPECT_DOUBLE_EQ(brake(0.0, 0.0), 3.0);
  tracking_.Reset();
  EXPECT_DOUBLE_EQ(brake(0.0, 0.0), 1.0);
}

// On a circle of 25 m, comfort allows 3 m/s². With μ = 0.3 the tyres give 0.27 g, of which nine tenths are used for a bend
// and for braking together.
TEST(TrackingProblem, WhereTheTyresGiveLessTheReferenceIsSlower) {
  const RoadProfile road(testing::CircularRoad(25.0, 5.0, 12.0), {}, {});
  TrackingProblem tracking({}, road, kSettings);
  const auto speed = [&](double mu_limit) {
    tracking.SetFrictionLimit(mu_limit);
    tracking.Begin(At(0.0, 0.0, 8.0), 0.0, {});
    EXPECT_NEAR(tracking.SpeedLimit(40), std::max(tracking.reference()[40][kUpsilon], 6.0) + 0.3, 0.35);
    return tracking.reference()[40][kUpsilon];
  };
  const double comfort = std::sqrt(3.0 * 25.0);
  EXPECT_NEAR(speed(kNoLimit), comfort, 0.05);
  EXPECT_NEAR(speed(0.3), comfort * std::sqrt(0.9 * 0.27 * 9.81 / std::hypot(3.0, 2.0)), 0.05);
  EXPECT_NEAR(speed(kNoLimit), comfort, 0.05);
}

TEST_F(TrackingProblemTest, OfManyObstaclesBesideAStepTheNearestHaveRows) {
  std::vector<Obstacle> obstacles;
  for (int k = 0; k < 60; ++k) obstacles.push_back(Circle(k, 62.0, k % 2 == 0 ? -3.8 + 0.005 * k : 3.9, 0.1));
  tracking_.Begin(At(50.0, 0.0, 12.0), 50.0, obstacles);
  EXPECT_EQ(tracking_.manoeuvre().objects.size(), RoadObjects::kMost);
  EXPECT_EQ(tracking_.manoeuvre().left_out, 60 - RoadObjects::kMost);
  tracking_.BuildConstraints(Straight(12.0));
  const auto rows = ObstacleRows(20);
  ASSERT_EQ(rows.size(), 2 * TrackingProblem::kMostObstacles);
  for (const BodyRow& row : rows) EXPECT_GT(row.normal.y(), 0.5) << "those on the left are farther away";
}

}  // namespace
}  // namespace control
