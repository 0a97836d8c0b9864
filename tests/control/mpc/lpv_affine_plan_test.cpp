// Constraints that the plans of LpvAffineMpc satisfy, and how these are relaxed where not all can be satisfied.
#include <algorithm>
#include <cmath>

#include "control/mpc/lpv_affine_mpc.hpp"
#include "gtest/gtest.h"
#include "tests/control/mpc/road_loop.hpp"
#include "tests/control/roads.hpp"

namespace control {
namespace {

using testing::BusyRoad;
using testing::RoadLoop;
using testing::StraightRoad;

TEST(LpvAffinePlan, PlanKeepsToRangesAndRatesOfTheInputs) {
  BusyRoad loop;
  loop.PlaceAt(0.0, 12.0, 1.5);
  const LpvAffineSettings& s = loop.settings();
  double most_used = 0.0;
  while (loop.s() < 130.0) {
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved) << loop.s();
    Input last = loop.u();
    for (const Input& u : plan.u) {
      for (int j = 0; j < kInputs; ++j) {
        EXPECT_GE(u[j], s.u_min[j] - 1e-6);
        EXPECT_LE(u[j], s.u_max[j] + 1e-6);
        EXPECT_LE(std::abs(u[j] - last[j]), s.rate_max[j] + 1e-6);
      }
      most_used = std::max(most_used, std::abs(u[kDelta] - last[kDelta]) / s.rate_max[kDelta]);
      last = u;
    }
    loop.Drive(plan);
  }
  EXPECT_GT(most_used, 0.9) << "nothing was limited: the test shows nothing";
}

TEST(LpvAffinePlan, PlanIsWhatTheNonlinearModelDoesWithItsInputs) {
  BusyRoad loop;
  double largest = 0.0;
  for (int k = 0; loop.s() < 130.0; ++k) {
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved);
    State z = loop.z();
    for (std::size_t i = 0; i < plan.u.size(); ++i) z = loop.model().Step(z, plan.u[i]);
    largest = std::max(largest, (z - plan.z.back()).head<2>().norm());
    loop.Drive(plan);
  }
  EXPECT_LT(largest, 0.5);  // [m] of 24 m, 2 s ahead
}

TEST(LpvAffinePlan, PlanStaysWithinTheFrictionThatThereIs) {
  RoadLoop loop(StraightRoad(300.0, 14.0));
  loop.PlaceAt(0.0, 14.0);
  loop.obstacles() = {loop.ObstacleAt(62.0, -0.9, 1.4)};
  const double grip = loop.settings().friction_share * loop.settings().mu * 9.81;
  double most_used = 0.0;
  while (loop.s() < 100.0) {
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved);
    for (std::size_t i = 1; i < plan.z.size() && plan.relaxation.amount == 0.0; ++i) {
      const double across = plan.z[i][kUpsilon] * plan.z[i][kOmega];
      const double along = plan.u[i - 1][kAcceleration];
      // The product is bounded to first order.
      EXPECT_LT(std::abs(across), 1.03 * grip);
      EXPECT_LT(std::abs(across) + std::abs(along), 1.03 * std::sqrt(2.0) * grip);
      most_used = std::max(most_used, (std::abs(across) + std::abs(along)) / grip);
    }
    loop.Drive(plan);
  }
  EXPECT_GT(most_used, 0.4);
}

TEST(LpvAffinePlan, SlipperyRoadIsAskedForLessAcross) {
  double across_before = 1e300;
  for (const double mu : {0.7, 0.25}) {
    LpvAffineSettings settings;
    settings.mu = mu;
    RoadLoop loop(StraightRoad(300.0, 12.0), settings);
    loop.PlaceAt(0.0, 12.0, 2.5);
    double across = 0.0;
    for (int k = 0; k < 60; ++k) {
      const Plan& plan = loop.Ask();
      ASSERT_EQ(plan.status, SolverStatus::kSolved);
      loop.Drive(plan);
      across = std::max(across, std::abs(loop.z()[kUpsilon] * loop.z()[kOmega]));
    }
    const double grip = settings.friction_share * mu * 9.81;
    EXPECT_LT(across, 1.05 * grip) << mu;
    EXPECT_LT(across, across_before);
    across_before = across;
  }
}

TEST(LpvAffinePlan, SlipperyRoadIsAskedForLessWhenBraking) {
  LpvAffineSettings settings;
  settings.mu = 0.3;
  RoadLoop loop(StraightRoad(300.0, 12.0), settings);
  loop.PlaceAt(0.0, 12.0);
  loop.obstacles() = {loop.ObstacleAt(36.0, 0.0, 6.0)};
  const double grip = settings.friction_share * settings.mu * 9.81;
  double hardest = 0.0;
  for (int k = 0; k < 60; ++k) {
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved);
    for (const Input& u : plan.u) hardest = std::max(hardest, -u[kAcceleration]);
    loop.Drive(plan);
  }
  EXPECT_LT(hardest, grip + 1e-4);
  EXPECT_GT(hardest, 0.9 * grip) << "the road is blocked 30 m ahead";
}

// A vehicle sets off on ice, within a bend and on a straight road.
TEST(LpvAffinePlan, SlipperyRoadIsAskedForLessOfOneDrivenAxle) {
  LpvAffineSettings settings;
  settings.mu = 0.15;
  const double grip = settings.friction_share * settings.mu * 9.81;
  const auto most = [&](const Route& route, const VehicleParameters& vehicle) {
    const RoadProfile profile(route, {}, {});
    LpvAffineMpc mpc(vehicle, profile, settings);
    State z = State::Zero();
    const RoutePoint start = profile.At(20.0);
    z << start.X, start.Y, 3.0, 0.0, start.psi, 3.0 * start.curvature;
    ControllerInput input;
    input.z = z;
    input.place.s = 20.0;
    const Plan& plan = mpc.Step(input);
    EXPECT_EQ(plan.status, SolverStatus::kSolved);
    double a = 0.0;
    for (std::size_t i = 0; i < plan.u.size(); ++i) {
      a = std::max(a, plan.u[i][kAcceleration]);
      const double across = plan.z[i + 1][kUpsilon] * plan.z[i + 1][kOmega];
      EXPECT_LE(std::hypot(across, TyreDemand(vehicle, plan.u[i][kAcceleration])), 1.1 * grip) << i;
    }
    return a;
  };
  const double whole = most(StraightRoad(300.0, 12.0), {});
  const double rear = most(StraightRoad(300.0, 12.0), {.driven = DrivenAxle::kRear});
  EXPECT_LE(rear, 1.04 / 2.44 * grip + 1e-6);
  EXPECT_GT(rear, 0.9 * 1.04 / 2.44 * grip);
  EXPECT_GT(whole, 1.2 * rear);
  EXPECT_LT(most(testing::CircularRoad(10.0, 3.0, 12.0), {.driven = DrivenAxle::kRear}), 0.9 * rear);
}

TEST(LpvAffinePlan, InputThatIsOutOfRangeComesBackAsFastAsItMay) {
  for (const Input& out : {Input(0.62, 0.0), Input(-0.62, 0.0), Input(0.0, -8.5), Input(0.0, 4.2)}) {
    RoadLoop loop(StraightRoad(200.0, 6.0));
    loop.PlaceAt(20.0, 3.0);
    loop.u() = out;
    const LpvAffineSettings& s = loop.settings();
    const auto excess = [&](const Input& u) {
      return Input((u - s.u_max).cwiseMax(s.u_min - u).cwiseMax(0.0));
    };
    for (int k = 0; k < 8; ++k) {
      const Input before = loop.u();
      const Plan& plan = loop.Ask();
      ASSERT_EQ(plan.status, SolverStatus::kSolved) << out.transpose() << ", step " << k;
      for (int j = 0; j < kInputs; ++j) {
        EXPECT_LE(std::abs(plan.u[0][j] - before[j]), s.rate_max[j] + 1e-6);
        EXPECT_LE(excess(plan.u[0])[j], std::max(excess(before)[j] - s.rate_max[j], 0.0) + 1e-6);
      }
      loop.Drive(plan);
    }
    EXPECT_LT(excess(loop.u()).maxCoeff(), 1e-6);
  }
}

TEST(LpvAffinePlan, ObstacleThatIsTooNearIsNamedWithStepAndAmount) {
  RoadLoop loop(StraightRoad(300.0, 12.0));
  loop.PlaceAt(50.0, 6.0);
  loop.obstacles() = {loop.ObstacleAt(50.0, -1.5, 0.8)};  // beside it; 0.9 + 0.3 + 0.8 m are required
  loop.obstacles()[0].id = 7;
  const Plan& plan = loop.Ask();
  ASSERT_EQ(plan.status, SolverStatus::kSolved);
  EXPECT_EQ(plan.relaxation.constraint.kind, ConstraintKind::kObstacle);
  EXPECT_EQ(plan.relaxation.constraint.index, 7);
  EXPECT_LE(plan.relaxation.constraint.step, 8) << "as long as it is beside it";
  EXPECT_NEAR(plan.relaxation.amount, 0.5, 0.1);
}

TEST(LpvAffinePlan, RoadThatIsLeftIsNamedWithStepAndAmount) {
  LpvAffineSettings settings;
  settings.footprint = {.front = 0.0, .rear = 0.0, .half_width = 0.9};  // no end that swings outwards
  RoadLoop loop(StraightRoad(300.0, 12.0), settings);
  loop.PlaceAt(50.0, 12.0, 3.5);  // 0.4 m over the edge, plus the margin
  const Plan& plan = loop.Ask();
  ASSERT_EQ(plan.status, SolverStatus::kSolved);
  EXPECT_EQ(plan.relaxation.constraint.kind, ConstraintKind::kRoad);
  EXPECT_EQ(plan.relaxation.constraint.step, 1);
  EXPECT_NEAR(plan.relaxation.amount, 0.4 + settings.road_margin, 0.02);
}

// The gap is 2.2 m wide and the vehicle 1.8 m: 0.3 m on one side and 0.2 m on the other do not fit, and it is too late to
// stop.
TEST(LpvAffinePlan, MarginsShrinkToWhatThereIs) {
  LpvAffineSettings settings;
  settings.road_margin = 0.2;
  RoadLoop loop(StraightRoad(300.0, 12.0), settings, RoadBounds{.left = 1.8, .right = -1.8});
  loop.PlaceAt(50.0, 12.0, 0.5);
  loop.obstacles() = {loop.ObstacleAt(58.0, -1.1, 0.7)};
  const Plan& plan = loop.Ask();
  ASSERT_EQ(plan.status, SolverStatus::kSolved);
  EXPECT_LT(plan.relaxation.amount, 0.1);
  for (const State& z : plan.z) {
    EXPECT_LT(z[kY] + 0.9, 1.8);
    if (std::abs(z[kX] - 58.0) < 0.5) {
      EXPECT_GT(z[kY] - 0.9, -0.4);
    }
  }
}

TEST(LpvAffinePlan, NothingIsGivenUpWhereEverythingFits) {
  RoadLoop loop(StraightRoad(300.0, 12.0));
  loop.obstacles() = {loop.ObstacleAt(60.0, -0.5, 0.7)};
  while (loop.s() < 90.0) {
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved);
    EXPECT_LT(plan.relaxation.amount, 0.01) << loop.s();
    loop.Drive(plan);
  }
}

}  // namespace
}  // namespace control
