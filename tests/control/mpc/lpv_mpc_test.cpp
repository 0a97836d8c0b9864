#include "control/mpc/lpv_mpc.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gtest/gtest.h"
#include "tests/control/mpc/closed_loop.hpp"

namespace control {
namespace {

using testing::ClosedLoop;
using testing::StraightPath;

LpvMpc Make(const LpvMpcSettings& settings = {}) {
  return {VehicleParameters{}, settings};
}

// Expects every input within its bounds and rates, the first relative to the input last applied.
void ExpectInputsWithinBounds(const LpvMpcSettings& s, const Plan& plan, const Input& u_previous) {
  Input last = u_previous;
  for (const Input& u : plan.u) {
    for (int j = 0; j < kInputs; ++j) {
      EXPECT_GE(u[j], s.u_min[j] - 1e-6);
      EXPECT_LE(u[j], s.u_max[j] + 1e-6);
      EXPECT_LE(std::abs(u[j] - last[j]), s.rate_max[j] + 1e-6);
    }
    last = u;
  }
}

TEST(LpvMpc, OnTheReferenceNothingNeedsToBeDone) {
  for (const bool trust_region : {true, false}) {
    LpvMpcSettings settings;
    settings.trust_region = trust_region;
    LpvMpc mpc = Make(settings);
    ClosedLoop loop(mpc, StraightPath(100, 12.0));
    while (loop.k() < 60) {
      const Plan& plan = loop.Ask();
      ASSERT_EQ(plan.status, SolverStatus::kSolved);
      EXPECT_LT(plan.u[0].cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_EQ(plan.active_trust_rows, 0);
      loop.Drive(plan);
      EXPECT_LT((loop.z() - loop.z_ref()).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

TEST(LpvMpc, VehicleOffThePathIsBroughtBackWithinAllBounds) {
  for (const auto method : {Discretisation::kEuler, Discretisation::kZeroOrderHold}) {
    LpvMpcSettings settings;
    settings.discretisation = method;
    LpvMpc mpc = Make(settings);
    ClosedLoop loop(mpc, StraightPath(300, 12.0));
    loop.z()[kY] = 0.6;
    loop.z()[kX] = -0.5;
    loop.z()[kUpsilon] = 11.0;
    double largest_lateral = 0.6;
    while (loop.k() < 200) {
      const Plan& plan = loop.Ask();
      ASSERT_EQ(plan.status, SolverStatus::kSolved) << loop.k();
      ExpectInputsWithinBounds(settings, plan, loop.u());
      loop.Drive(plan);
      largest_lateral = std::max(largest_lateral, std::abs(loop.z()[kY]));
    }
    EXPECT_LT(largest_lateral, 0.7);
    EXPECT_LT(std::abs(loop.z()[kY]), 0.02);
    EXPECT_LT(std::abs(loop.z()[kX] - loop.z_ref()[kX]), 0.1);
    EXPECT_NEAR(loop.z()[kUpsilon], 12.0, 0.05);
  }
}

TEST(LpvMpc, PlanObeysTheModelThatTheQpWasBuiltWith) {
  LpvMpc mpc = Make();
  ClosedLoop loop(mpc, StraightPath(100, 12.0));
  loop.z()[kY] = 0.4;
  loop.z()[kPsi] = 0.02;
  const LpvModel model(VehicleParameters{});
  std::vector<State> scheduled_z(9, loop.z());  // the first step is scheduled by the measured state alone
  std::vector<Input> scheduled_u(8, Input::Zero());
  while (loop.k() < 20) {
    const State measured = loop.z();
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved);
    EXPECT_LT((plan.z[0] - measured).cwiseAbs().maxCoeff(), 1e-12);
    for (std::size_t i = 0; i < 8; ++i) {
      const LinearModel d = model.Discrete({.upsilon = scheduled_z[i][kUpsilon],
                                            .nu = scheduled_z[i][kNu],
                                            .delta = scheduled_u[i][kDelta],
                                            .psi = scheduled_z[i][kPsi]},
                                           testing::kStep, Discretisation::kEuler);
      EXPECT_LT((d.A * plan.z[i] + d.B * plan.u[i] - plan.z[i + 1]).cwiseAbs().maxCoeff(), 1e-9);
    }
    for (std::size_t i = 0; i < 8; ++i) {  // ẑ of the next step is this plan, shifted by one step
      scheduled_z[i] = plan.z[i + 1];
      scheduled_u[i] = plan.u[std::min<std::size_t>(i + 1, 7)];
    }
    loop.Drive(plan);
  }
}

TEST(LpvMpc, HeavyTrustRegionKeepsTheScheduledQuantitiesWithinItsRadii) {
  LpvMpcSettings settings;
  settings.E_p.setConstant(1e7);
  settings.trust_radius << 0.5, 0.02, 0.004, 0.01;
  LpvMpc mpc = Make(settings);
  ClosedLoop loop(mpc, StraightPath(200, 12.0));
  loop.z()[kY] = 0.5;
  Plan last = loop.Ask();
  int active = 0;
  while (loop.k() < 40) {
    loop.DriveAsPredicted(last);
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved) << loop.k();
    for (std::size_t i = 0; i < 8; ++i) {
      const std::size_t shifted = std::min<std::size_t>(i + 1, 7);
      EXPECT_LE(std::abs(plan.u[i][kDelta] - last.u[shifted][kDelta]), 0.01 + 1e-4);
      if (i == 0) continue;
      EXPECT_LE(std::abs(plan.z[i][kUpsilon] - last.z[i + 1][kUpsilon]), 0.5 + 1e-4);
      EXPECT_LE(std::abs(plan.z[i][kNu] - last.z[i + 1][kNu]), 0.02 + 1e-4);
      EXPECT_LE(std::abs(plan.z[i][kPsi] - last.z[i + 1][kPsi]), 0.004 + 1e-4);
    }
    EXPECT_LT(plan.largest_slack, 1e-2);
    active += plan.active_trust_rows;
    last = plan;
  }
  EXPECT_GT(active, 0) << "nothing was limited: the test shows nothing";
}

TEST(LpvMpc, WithoutTrustRegionNothingOfItIsReported) {
  LpvMpcSettings settings;
  settings.trust_region = false;
  LpvMpc mpc = Make(settings);
  ClosedLoop loop(mpc, StraightPath(100, 12.0));
  loop.z()[kY] = 0.6;
  while (loop.k() < 20) {
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved);
    EXPECT_EQ(plan.active_trust_rows, 0);
    EXPECT_EQ(plan.largest_slack, 0.0);
    loop.Drive(plan);
  }
}

// At low speed Euler's model of the lateral motion is unstable, by a factor of 7 per step at 3 m/s; the QP must still
// be solved. At lower speeds its round-off approaches the solver's tolerance.
TEST(LpvMpc, SlowVehicleIsStillSolvedFor) {
  for (const auto method : {Discretisation::kEuler, Discretisation::kZeroOrderHold}) {
    for (const int horizon : {8, 15, 40}) {
      for (const double speed : {1.2, 3.0, 6.0}) {
        if (method == Discretisation::kEuler && speed < 3.0) continue;
        LpvMpcSettings settings;
        settings.discretisation = method;
        settings.horizon = horizon;
        LpvMpc mpc = Make(settings);
        ClosedLoop loop(mpc, StraightPath(60, speed));
        loop.z()[kY] = 0.1;
        while (loop.k() < 20) {
          const Plan& plan = loop.Ask();
          ASSERT_EQ(plan.status, SolverStatus::kSolved)
              << "N = " << horizon << ", " << speed << " m/s, step " << loop.k();
          loop.Drive(plan);
        }
      }
    }
  }
}

TEST(LpvMpc, SchedulingErrorIsTheDistanceFromThePredictionInRadii) {
  LpvMpc mpc = Make();
  ClosedLoop loop(mpc, StraightPath(100, 12.0));
  loop.z()[kY] = 0.4;
  EXPECT_EQ(loop.Ask().scheduling_error, 0.0);  // nothing has been predicted yet
  mpc.Reset();
  loop.DriveAsPredicted(loop.Ask());
  for (int i = 0; i < 10; ++i) {
    const Plan& plan = loop.Ask();
    EXPECT_LT(plan.scheduling_error, 1e-12);
    loop.DriveAsPredicted(plan);
  }
  loop.z()[kNu] += 0.15;      // half a radius
  loop.z()[kUpsilon] -= 0.1;  // a fifth of one
  EXPECT_NEAR(loop.Ask().scheduling_error, 0.5, 1e-9);
}

TEST(LpvMpc, ResetForgetsTheLastPlan) {
  LpvMpc used = Make(), fresh = Make();
  ClosedLoop loop(used, StraightPath(100, 12.0));
  loop.z()[kY] = 0.5;
  while (loop.k() < 10) loop.Drive(loop.Ask());
  used.Reset();
  const Plan after_reset = loop.Ask();
  const Plan& first = fresh.Step(loop.Asked());
  EXPECT_EQ(after_reset.status, first.status);
  EXPECT_EQ(after_reset.iterations, first.iterations);
  EXPECT_EQ(after_reset.scheduling_error, 0.0);
  for (std::size_t i = 0; i < first.u.size(); ++i) EXPECT_EQ(after_reset.u[i], first.u[i]);
}

TEST(LpvMpc, VehicleStaysOnTheRoad) {
  LpvMpc mpc = Make();
  ClosedLoop loop(mpc, StraightPath(150, 12.0));
  loop.road() = {.left = 0.5, .right = -0.4};
  loop.z()[kY] = 0.49;
  while (loop.k() < 100) {
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved) << loop.k();
    for (std::size_t i = 1; i < plan.z.size(); ++i) {
      EXPECT_LT(plan.z[i][kY], 0.5 + 1e-6);
      EXPECT_GT(plan.z[i][kY], -0.4 - 1e-6);
    }
    loop.Drive(plan);
  }
}

TEST(LpvMpc, EachStepKeepsToTheEdgesBesideIt) {
  LpvMpc mpc = Make();
  ClosedLoop loop(mpc, StraightPath(150, 12.0));
  loop.z()[kY] = 0.5;
  static_cast<void>(loop.Ask());
  TrackingInput input = loop.Asked();
  std::vector<RoadBounds> road(input.reference.size());
  const std::size_t last = road.size() - 1;
  road[last].left = 0.1;
  input.road = road;
  mpc.Reset();
  const Plan& plan = mpc.Step(input);
  ASSERT_EQ(plan.status, SolverStatus::kSolved);
  EXPECT_LT(plan.z[last][kY], 0.1 + 1e-6);
  EXPECT_GT(plan.z[last - 1][kY], 0.1) << "it is in no hurry before";
}

TEST(LpvMpc, WhatStandsInTheWayIsNamedWithTheLeastRelaxation) {
  LpvMpc mpc = Make();
  ClosedLoop loop(mpc, StraightPath(150, 12.0));
  loop.road() = {.left = 0.5, .right = -0.5};
  loop.z()[kY] = 0.9;  // heading straight on, so still there after one step
  ASSERT_EQ(loop.Ask().status, SolverStatus::kInfeasible);
  const auto violation = mpc.DiagnoseInfeasibility();
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.kind, ConstraintKind::kRoad);
  EXPECT_EQ(violation->constraint.step, 1);
  EXPECT_NEAR(violation->amount, 0.4, 1e-3);

  loop.road() = {};
  loop.obstacles() = {{.id = 5, .X = 0.6, .Y = 0.0, .r_x = 1.0, .r_y = 1.0, .side = PassingSide::kLeft}};
  ASSERT_EQ(loop.Ask().status, SolverStatus::kInfeasible);
  ASSERT_TRUE(mpc.DiagnoseInfeasibility());
  EXPECT_EQ(mpc.DiagnoseInfeasibility()->constraint.kind, ConstraintKind::kObstacle);
  EXPECT_EQ(mpc.DiagnoseInfeasibility()->constraint.index, 5);
}

// A winding road at 12 m/s with a circle of radius 1 m, 0.5 m beside the path: a shift of 0.5 m (plus margin).
struct WindingRoad {
  TimeReference reference =
      testing::PathOf(420, 12.0, [](int k) { return k < 80 ? 0.0 : 0.01 * std::sin((k - 80) * 0.012); });
  Obstacle obstacle{.r_x = 1.0, .r_y = 1.0, .side = PassingSide::kLeft};

  WindingRoad() {
    const State& at = reference[250];
    obstacle.X = at[kX] + 0.5 * std::sin(at[kPsi]);
    obstacle.Y = at[kY] - 0.5 * std::cos(at[kPsi]);
  }
};

struct Drive {
  bool solved = true;
  int failed_at = -1;
  double clearance = 1e300;  // least distance from the obstacle's circumference [m]
  double largest_offset = 0.0;
  bool passed_left = true;
};

Drive DriveAlong(const WindingRoad& road, const LpvMpcSettings& settings) {
  LpvMpc mpc = Make(settings);
  ClosedLoop loop(mpc, road.reference);
  loop.obstacles() = {road.obstacle};
  Drive drive;
  while (loop.k() < 390) {
    const Plan& plan = loop.Ask();
    if (plan.status != SolverStatus::kSolved) {
      drive.solved = false;
      drive.failed_at = loop.k();
      EXPECT_EQ(plan.status, SolverStatus::kInfeasible);
      return drive;
    }
    ExpectInputsWithinBounds(settings, plan, loop.u());
    loop.Drive(plan);
    const State &z = loop.z(), &z_ref = loop.z_ref();
    const double dX = z[kX] - road.obstacle.X, dY = z[kY] - road.obstacle.Y;
    drive.clearance = std::min(drive.clearance, std::hypot(dX, dY) - 1.0);
    if (std::hypot(dX, dY) < 2.0) {
      drive.passed_left &= -std::sin(z_ref[kPsi]) * dX + std::cos(z_ref[kPsi]) * dY > 0.0;
    }
    drive.largest_offset = std::max(
        drive.largest_offset,
        std::abs(-std::sin(z_ref[kPsi]) * (z[kX] - z_ref[kX]) + std::cos(z_ref[kPsi]) * (z[kY] - z_ref[kY])));
  }
  return drive;
}

TEST(LpvMpcAtAnObstacle, TrustRegionDrivesAroundItOnTheGivenSide) {
  for (const int horizon : {8, 15}) {
    LpvMpcSettings settings;
    settings.horizon = horizon;
    const Drive drive = DriveAlong({}, settings);
    EXPECT_TRUE(drive.solved) << "N = " << horizon << ", step " << drive.failed_at;
    EXPECT_GE(drive.clearance, 0.0) << horizon;
    EXPECT_TRUE(drive.passed_left);
    EXPECT_LT(drive.largest_offset, 1.5);
  }
}

TEST(LpvMpcAtAnObstacle, StandardControllerBecomesInfeasibleWhereTheTrustRegionDoesNot) {
  LpvMpcSettings settings;
  settings.trust_region = false;
  settings.horizon = 15;
  const Drive drive = DriveAlong({}, settings);
  EXPECT_FALSE(drive.solved);
  EXPECT_GT(drive.failed_at, 230);
}

TEST(LpvMpcAtAnObstacle, ObstaclesThatDoNotFitMakeTheProblemInfeasible) {
  LpvMpc mpc = Make();
  ClosedLoop loop(mpc, StraightPath(100, 12.0));
  // All obstacles are identical and easy to pass.
  const Obstacle easy{.X = 4.0, .Y = -0.99, .side = PassingSide::kLeft};
  loop.obstacles().assign(13, easy);
  ASSERT_EQ(loop.Ask().status, SolverStatus::kSolved);
  ASSERT_EQ(loop.Ask().status, SolverStatus::kSolved);  // now with the trust region's rows
  for (const std::size_t count : {14u, 18u, 100u}) {
    loop.obstacles().assign(count, easy);
    std::size_t held = 0;
    const Plan& plan = loop.Ask();
    for (const auto& stage : mpc.qp().stages)
      held = std::max(held, static_cast<std::size_t>(stage.row_count));
    EXPECT_EQ(plan.status, SolverStatus::kInfeasible) << count << " obstacles, " << held << " rows";
  }
}

TEST(LpvMpc, MeasurementThatIsNotFiniteFailsAndTheNextGoodStepRecovers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool warm : {false, true}) {
    for (int entry = 0; entry < kStates; ++entry) {
      LpvMpc mpc = Make();
      ClosedLoop loop(mpc, StraightPath(100, 12.0));
      loop.z()[kY] = 0.3;
      while (warm && loop.k() < 5) loop.Drive(loop.Ask());
      const State good = loop.z();
      for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
        loop.z()[entry] = bad;
        EXPECT_EQ(loop.Ask().status, SolverStatus::kNumericalFailure) << entry;
      }
      loop.z() = good;
      const Plan& plan = loop.Ask();
      EXPECT_EQ(plan.status, SolverStatus::kSolved) << entry;
      EXPECT_TRUE(plan.u[0].allFinite());
    }
  }
}

TEST(LpvMpc, AnyInputThatIsNotFiniteFails) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  LpvMpc mpc = Make();
  ClosedLoop loop(mpc, StraightPath(100, 12.0));
  const Obstacle ahead{.X = 4.0, .Y = -0.8, .side = PassingSide::kLeft};
  loop.obstacles() = {ahead};
  ASSERT_EQ(loop.Ask().status, SolverStatus::kSolved);
  loop.road().left = nan;
  EXPECT_EQ(loop.Ask().status, SolverStatus::kNumericalFailure) << "road";
  loop.road() = {};
  for (double Obstacle::*member :
       {&Obstacle::X, &Obstacle::Y, &Obstacle::r_x, &Obstacle::r_y, &Obstacle::heading}) {
    loop.obstacles() = {ahead};
    loop.obstacles()[0].*member = nan;
    EXPECT_NE(loop.Ask().status, SolverStatus::kSolved) << "obstacle";
  }
  loop.obstacles() = {ahead};
  EXPECT_EQ(loop.Ask().status, SolverStatus::kSolved);
}

}  // namespace
}  // namespace control
