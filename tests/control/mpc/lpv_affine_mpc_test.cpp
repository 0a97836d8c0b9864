#include "control/mpc/lpv_affine_mpc.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

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

TEST(LpvAffineMpc, SchedulingErrorIsTheDistanceFromThePredictionInRadii) {
  RoadLoop loop(StraightRoad(200.0, 12.0));
  loop.PlaceAt(0.0, 12.0, 0.5);
  EXPECT_EQ(loop.Ask().scheduling_error, 0.0) << "nothing was predicted";
  for (int k = 0; k < 10; ++k) {
    loop.Drive(loop.Ask());
    EXPECT_LT(loop.Ask().scheduling_error, 0.05) << "the model is the vehicle";
  }
  State& z = loop.z();
  z = loop.Ask().z[1];
  z[kNu] += 0.25;      // half a radius
  z[kUpsilon] -= 0.2;  // a fifth of one
  EXPECT_NEAR(loop.Ask().scheduling_error, 0.5, 1e-9);
}

// Half width of the trust region in υ in the last step's QP, as a multiple of trust_radius.
double RadiusOfSpeed(const RoadLoop& loop, const LpvAffineMpc& mpc) {
  const auto& stage = mpc.qp().stages[5];
  for (int j = 0; j < stage.row_count; ++j) {
    const auto& row = stage.rows[static_cast<std::size_t>(j)];
    if (row.unit == kUpsilon && row.soft() && row.sigma == 0.0) {
      return 0.5 * (row.hi - row.lo) / loop.settings().trust_radius[0];
    }
  }
  return 0.0;
}

TEST(LpvAffineMpc, TrustRegionWidensWhilePredictionsComeTrueAndNarrowsWhereTheyDoNot) {
  for (const bool adapt : {true, false}) {
    LpvAffineSettings settings;
    settings.adapt_trust_region = adapt;
    RoadLoop loop(StraightRoad(300.0, 12.0), settings);
    loop.Drive(loop.Ask());
    loop.Drive(loop.Ask());
    const double first = RadiusOfSpeed(loop, loop.mpc());
    EXPECT_NEAR(first, adapt ? 1.1 : 1.0, 1e-9);
    for (int k = 0; k < 20; ++k) loop.Drive(loop.Ask());
    EXPECT_NEAR(RadiusOfSpeed(loop, loop.mpc()), adapt ? 2.0 : 1.0, 1e-9);
    for (int k = 0; k < 20; ++k) {
      loop.Drive(loop.Ask());
      loop.z()[kNu] += k % 2 == 0 ? 0.8 : -0.8;
      EXPECT_EQ(loop.Ask().status, SolverStatus::kSolved);
    }
    EXPECT_NEAR(RadiusOfSpeed(loop, loop.mpc()), adapt ? 0.5 : 1.0, 1e-9);
  }
}

TEST(LpvAffineMpc, WithoutTrustRegionNothingOfItIsReported) {
  LpvAffineSettings settings;
  settings.trust_region = false;
  BusyRoad loop(settings);
  for (int k = 0; k < 30; ++k) {
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved);
    EXPECT_EQ(plan.active_trust_rows, 0);
    EXPECT_EQ(plan.largest_slack, 0.0);
    EXPECT_EQ(RadiusOfSpeed(loop, loop.mpc()), 0.0);
    loop.Drive(plan);
  }
}

TEST(LpvAffineMpc, ResetForgetsTheLastPlanAndTheSides) {
  BusyRoad loop;
  while (loop.s() < 30.0) loop.Drive(loop.Ask());
  loop.mpc().Reset();
  const Plan after_reset = loop.Ask();
  LpvAffineMpc fresh(VehicleParameters{}, loop.profile(), loop.settings());
  const Plan& first = fresh.Step(loop.Asked());
  EXPECT_EQ(after_reset.status, first.status);
  EXPECT_EQ(after_reset.iterations, first.iterations);
  EXPECT_EQ(after_reset.scheduling_error, 0.0);
  EXPECT_EQ(after_reset.u, first.u);
  EXPECT_NE(loop.Ask().u, first.u) << "the second step has a plan to start from";
}

// The second step's plan after at most `iterations` iterations, with `time_left` as the clock.
std::vector<Input> PlanWithin(int iterations, const std::function<bool()>& time_left) {
  LpvAffineSettings settings;
  settings.iterations = iterations;
  settings.converged = 0.0;
  BusyRoad loop(settings);
  loop.PlaceAt(40.0, 9.0, 0.5);
  loop.Drive(loop.Ask());
  ControllerInput input = loop.Asked();
  input.time_left = &time_left;
  const Plan& plan = loop.mpc().Step(input);
  EXPECT_EQ(plan.status, SolverStatus::kSolved);
  return plan.u;
}

TEST(LpvAffineMpc, TimeThatIsUpLeavesThePlanOfTheLastIterationThatWasFinished) {
  constexpr int kIterations = 4;
  std::vector<std::vector<Input>> finished;
  for (int count = 1; count <= kIterations; ++count) {
    finished.push_back(PlanWithin(count, [] { return true; }));
    EXPECT_EQ(std::ranges::count(finished, finished.back()), 1) << "each iteration changes the plan";
  }
  int granted = 0, asked = 0, before = 0;
  for (; before < kIterations - 1; ++granted) {
    asked = 0;
    const std::vector<Input> plan = PlanWithin(kIterations, [&] { return asked++ < granted; });
    const int index = static_cast<int>(std::ranges::find(finished, plan) - finished.begin());
    ASSERT_LT(index, kIterations) << "a plan that was not finished, with " << granted;
    EXPECT_GE(index, before);
    EXPECT_TRUE(granted > 0 || index == 0);
    before = index;
  }
  EXPECT_GT(granted, kIterations) << "the time is asked for within an iteration, too";
}

TEST(LpvAffineMpc, IterationsConverge) {
  std::vector<std::vector<Input>> plans;
  for (const int iterations : {1, 2, 3}) {
    LpvAffineSettings settings;
    settings.first_iterations = iterations;
    settings.iterations = iterations;
    settings.converged = 0.0;
    RoadLoop loop(WindingRoad(30.0, 12.0), settings);
    loop.PlaceAt(30.0, 12.0, 0.5);
    const Plan& plan = loop.Ask();
    ASSERT_EQ(plan.status, SolverStatus::kSolved);
    plans.push_back(plan.u);
  }
  const double first = LargestDifference(plans[1], plans[0]), second = LargestDifference(plans[2], plans[1]);
  EXPECT_GT(first, 1e-6);
  EXPECT_LT(second, 0.5 * first);
}

TEST(LpvAffineMpc, PlanThatHasConvergedIsNotIteratedOn) {
  LpvAffineSettings settings;
  settings.iterations = 50;
  RoadLoop loop(StraightRoad(300.0, 12.0), settings);
  for (int k = 0; k < 5; ++k) loop.Drive(loop.Ask());
  int asked = 0;
  const std::function<bool()> time_left = [&] { return ++asked > 0; };
  ControllerInput input = loop.Asked();
  input.time_left = &time_left;
  EXPECT_EQ(loop.mpc().Step(input).status, SolverStatus::kSolved);
  EXPECT_LT(asked, 4);
}

TEST(LpvAffineMpc, NoNumberOfObstaclesExhaustsTheProblem) {
  RoadLoop loop(StraightRoad(300.0, 12.0));
  loop.PlaceAt(20.0, 12.0);
  for (const std::size_t count : {7u, 8u, 16u, 17u, 64u}) {
    loop.obstacles().assign(count, loop.ObstacleAt(28.0, -3.4, 0.5));
    for (int k = 0; k < 3; ++k)  // from the second step on with the trust region's rows
      EXPECT_EQ(loop.Ask().status, SolverStatus::kSolved) << count;
  }
}

TEST(LpvAffineMpc, WhatIsNotFiniteFailsAndTheNextGoodStepRecovers) {
  BusyRoad loop;
  for (const bool warm : {false, true}) {
    while (warm && loop.s() < 20.0) loop.Drive(loop.Ask());
    const auto expect_failure = [&](double& entry) {
      const double good = entry;
      for (const double bad :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        entry = bad;
        const Plan& failed = loop.Ask();
        EXPECT_EQ(failed.status, SolverStatus::kNumericalFailure);
        EXPECT_FALSE(failed.manoeuvre) << "nothing was decided";
      }
      entry = good;
      const Plan& plan = loop.Ask();
      EXPECT_EQ(plan.status, SolverStatus::kSolved);
      EXPECT_TRUE(plan.u[0].allFinite());
      EXPECT_TRUE(plan.manoeuvre);
    };
    for (int j = 0; j < kStates; ++j) expect_failure(loop.z()[j]);
    for (int j = 0; j < kInputs; ++j) expect_failure(loop.u()[j]);
    for (double Obstacle::*member : {&Obstacle::X, &Obstacle::Y, &Obstacle::r_x, &Obstacle::r_y,
                                     &Obstacle::heading, &Obstacle::velocity_X, &Obstacle::velocity_Y}) {
      expect_failure(loop.obstacles()[0].*member);
    }
  }
}

}  // namespace
}  // namespace control
