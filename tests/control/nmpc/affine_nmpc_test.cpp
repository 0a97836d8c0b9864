#include "control/nmpc/affine_nmpc.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/mpc/lpv_affine_mpc.hpp"
#include "gtest/gtest.h"
#include "tests/control/mpc/road_loop.hpp"
#include "tests/control/roads.hpp"

namespace control {
namespace {

using testing::BusyRoad;
using testing::LargestDifference;
using testing::RoadLoop;
using testing::StraightRoad;
using testing::WindingRoad;

LpvAffineSettings Converging() {
  LpvAffineSettings settings;
  settings.trust_region = false;
  settings.first_iterations = settings.iterations = 20;
  settings.converged = 1e-6;
  return settings;
}

// Once converged, the QPs have solved the nonlinear problem.
void ExpectThatLpvAffineConvergesToIt(RoadLoop& loop, int steps) {
  AffineNmpc nmpc(VehicleParameters{}, loop.profile(), loop.settings(),
                  {.tolerance = 1e-6, .rounds = 20, .converged = 1e-5});
  double most = 0.0;
  for (int k = 0; k < steps; ++k) {
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved) << k;
    const Plan& nonlinear = nmpc.Step(loop.Asked());
    ASSERT_EQ(nonlinear.status, SolverStatus::kSolved) << k;
    EXPECT_LT(LargestDifference(plan.u, nonlinear.u), 1e-3) << k;
    EXPECT_NEAR(plan.relaxation.amount, nonlinear.relaxation.amount, 1e-3) << k;
    most = std::max(most, plan.u[0].cwiseAbs().maxCoeff());
    loop.Drive(plan);
  }
  EXPECT_GT(most, 0.05) << "nothing was done: the test shows nothing";
}

TEST(AffineNmpc, IsWhatLpvAffineConvergesTo) {
  RoadLoop loop(WindingRoad(30.0, 12.0), Converging());
  loop.PlaceAt(40.0, 10.0, 0.4);
  ExpectThatLpvAffineConvergesToIt(loop, 5);
}

TEST(AffineNmpc, IsWhatLpvAffineConvergesToBesideAnObstacle) {
  BusyRoad loop(Converging());
  loop.PlaceAt(46.0, 10.0, -0.5);
  ExpectThatLpvAffineConvergesToIt(loop, 5);
}

TEST(AffineNmpc, PlanObeysTheModelAndTheRangesAndRatesOfTheInputs) {
  BusyRoad loop;
  AffineNmpc nmpc(VehicleParameters{}, loop.profile(), loop.settings());
  const LpvAffineSettings& s = loop.settings();
  loop.PlaceAt(44.0, 12.0, 1.0);
  double most_used = 0.0;
  for (int k = 0; k < 8; ++k) {
    const Plan& plan = nmpc.Step(loop.Asked());
    ASSERT_EQ(plan.status, SolverStatus::kSolved) << k;
    Input last = loop.u();
    for (std::size_t i = 0; i < plan.u.size(); ++i) {
      EXPECT_LT((loop.model().Step(plan.z[i], plan.u[i]) - plan.z[i + 1]).cwiseAbs().maxCoeff(), 1e-3);
      for (int j = 0; j < kInputs; ++j) {
        EXPECT_GE(plan.u[i][j], s.u_min[j] - 1e-6);
        EXPECT_LE(plan.u[i][j], s.u_max[j] + 1e-6);
        EXPECT_LE(std::abs(plan.u[i][j] - last[j]), s.rate_max[j] + 1e-6);
      }
      most_used = std::max(most_used, std::abs(plan.u[i][kDelta] - last[kDelta]) / s.rate_max[kDelta]);
      last = plan.u[i];
    }
    loop.Drive(plan);
  }
  EXPECT_GT(most_used, 0.5) << "nothing was limited: the test shows nothing";
}

TEST(AffineNmpc, PassesAnObstacleWithItsFootprintClear) {
  RoadLoop loop(WindingRoad(40.0, 12.0));
  AffineNmpc nmpc(VehicleParameters{}, loop.profile(), loop.settings());
  loop.PlaceAt(68.0, 11.0);
  loop.obstacles() = {loop.ObstacleAt(85.0, -0.3, 0.8)};
  double clearance = 1e300, road_margin = 1e300;
  for (int k = 0; k < 140 && loop.s() < 95.0; ++k) {
    const Plan& plan = nmpc.Step(loop.Asked());
    ASSERT_EQ(plan.status, SolverStatus::kSolved) << k;
    ASSERT_TRUE(plan.manoeuvre);
    if (loop.s() < 80.0) {
      EXPECT_EQ(plan.manoeuvre->decision, Decision::kPass) << k;
    }
    loop.Drive(plan);
    clearance = std::min(clearance, loop.Clearance());
    road_margin = std::min(road_margin, loop.RoadMargin());
  }
  EXPECT_GE(loop.s(), 95.0) << "it went on";
  EXPECT_GT(clearance, 0.2);
  EXPECT_GT(road_margin, 0.1);
}

TEST(AffineNmpc, WhatCannotBeKeptToIsRelaxedAndNamed) {
  RoadLoop loop(StraightRoad(200.0, 12.0));
  AffineNmpc nmpc(VehicleParameters{}, loop.profile(), loop.settings());
  loop.PlaceAt(20.0, 12.0, 3.5);  // the left wheels are off the road
  const Plan& plan = nmpc.Step(loop.Asked());
  ASSERT_EQ(plan.status, SolverStatus::kSolved);
  EXPECT_EQ(plan.relaxation.constraint.kind, ConstraintKind::kRoad);
  EXPECT_NEAR(plan.relaxation.amount, 3.5 + 0.9 + loop.settings().road_margin - 4.0, 0.1);
}

TEST(AffineNmpc, InputOutOfRangeComesBackAsFastAsItMay) {
  RoadLoop loop(StraightRoad(200.0, 12.0));
  AffineNmpc nmpc(VehicleParameters{}, loop.profile(), loop.settings());
  const LpvAffineSettings& s = loop.settings();
  loop.PlaceAt(20.0, 5.0);
  loop.u()[kDelta] = s.u_max[kDelta] + 1.5 * s.rate_max[kDelta];
  const Plan& plan = nmpc.Step(loop.Asked());
  ASSERT_EQ(plan.status, SolverStatus::kSolved);
  EXPECT_NEAR(plan.u[0][kDelta], loop.u()[kDelta] - s.rate_max[kDelta], 0.01 * s.rate_max[kDelta]);
  EXPECT_LE(plan.u[1][kDelta], s.u_max[kDelta] + 1e-6);
}

TEST(AffineNmpc, HoldsAtTheEndOfTheCourse) {
  RoadLoop loop(StraightRoad(80.0, 12.0));
  AffineNmpc nmpc(VehicleParameters{}, loop.profile(), loop.settings());
  loop.PlaceAt(80.0, 0.0);
  for (int k = 0; k < 3; ++k) {
    const Plan& plan = nmpc.Step(loop.Asked());
    EXPECT_EQ(plan.status, SolverStatus::kSolved);
    EXPECT_EQ(plan.iterations, 0);
    loop.Drive(plan);
  }
  EXPECT_NEAR(loop.u()[kAcceleration], -1.0, 1e-9);
  EXPECT_LT(loop.z()[kUpsilon], 1e-9);
}

// The shifted last solution is close to the next one.
TEST(AffineNmpc, WarmStartSavesIterations) {
  const auto iterations = [](bool warm) {
    BusyRoad loop;
    AffineNmpc nmpc(VehicleParameters{}, loop.profile(), loop.settings());
    loop.PlaceAt(30.0, 10.0);
    int sum = 0;
    for (int k = 0; k < 8; ++k) {
      if (!warm) nmpc.Reset();
      const Plan& plan = nmpc.Step(loop.Asked());
      EXPECT_EQ(plan.status, SolverStatus::kSolved);
      sum += plan.iterations;
      loop.Drive(plan);
    }
    return sum;
  };
  EXPECT_LT(2 * iterations(true), iterations(false));
}

TEST(AffineNmpc, LimitOfIterationsIsReportedAsSuch) {
  RoadLoop loop(StraightRoad(200.0, 12.0));
  AffineNmpc nmpc(VehicleParameters{}, loop.profile(), loop.settings(), {.max_iterations = 1});
  loop.PlaceAt(20.0, 12.0, 0.5);
  EXPECT_EQ(nmpc.Step(loop.Asked()).status, SolverStatus::kIterationLimit);
}

TEST(AffineNmpc, WhatIsNotFiniteFailsAndTheNextGoodStepRecovers) {
  BusyRoad loop;
  AffineNmpc nmpc(VehicleParameters{}, loop.profile(), loop.settings());
  for (int k = 0; k < 2; ++k) {
    for (double* entry : {&loop.z()[kY], &loop.u()[kDelta], &loop.obstacles()[0].X}) {
      const double good = *entry;
      *entry = std::numeric_limits<double>::quiet_NaN();
      EXPECT_EQ(nmpc.Step(loop.Asked()).status, SolverStatus::kNumericalFailure);
      *entry = good;
    }
    const Plan& plan = nmpc.Step(loop.Asked());
    EXPECT_EQ(plan.status, SolverStatus::kSolved);
    EXPECT_TRUE(plan.u[0].allFinite());
    loop.Drive(plan);
  }
}

}  // namespace
}  // namespace control
