#include "loop/planner.hpp"

#include <gtest/gtest.h>
#include <vector>

#include "control/road/road_profile.hpp"

namespace loop {
namespace {

using namespace std::chrono_literals;
using control::ConstraintKind;
using control::Input;

// Takes the time and returns the plan that the test sets.
struct SlowController : control::Controller {
  explicit SlowController(base::Time& time) : clock(&time) {
    plan.status = control::SolverStatus::kSolved;
    plan.z.assign(5, control::State::Zero());
    plan.u.assign(4, Input::Zero());
  }
  int horizon() const override { return 4; }
  control::RouteProgress ProgressAt(const control::RoutePlace& /*place*/) const override { return {}; }
  const control::Plan& Step(const control::ControllerInput& input) override {
    ++steps;
    z = input.z;
    disturbance = input.disturbance;
    obstacles.assign(input.obstacles.begin(), input.obstacles.end());
    *clock += takes;
    time_left = (*input.time_left)();
    return plan;
  }
  void Reset() override { ++resets; }
  std::optional<control::ConstraintViolation> DiagnoseInfeasibility() const override {
    return {{.constraint = {.kind = ConstraintKind::kRoad}, .amount = 0.25}};
  }

  base::Time* clock;
  base::Time takes{};
  control::Plan plan;
  int steps = 0, resets = 0;
  control::State z;
  control::Disturbance disturbance;
  std::vector<control::Obstacle> obstacles;
  bool time_left = false;
};

class PlannerTest : public testing::Test {
 protected:
  PlannerTest() {
    known_.now = known_.state.timestamp = 10s;
    known_.step = 100;
    known_.state_new = true;
    known_.state.z << 10.0, 0.0, 10.0, 0.0, 0.0, 0.0;  // The vehicle is at X = 10 m and drives at 10 m/s.
  }
  Outcome Plan(PlanRequest request, bool commanding = false, const Input& applied = Input::Zero()) {
    planner_.StartStopwatch();
    return planner_.Plan(request, known_, {.s = 10.0}, commanding, applied);
  }

  base::Time clock_ = 7s;
  SlowController controller_{clock_};
  std::vector<control::RoutePiece> straight_{{.length = 99.5}};
  control::RoadProfile profile_{control::Route::FromPieces({}, 10.0, straight_), {}, {}};
  control::PlanCheckSettings check_settings_{.vehicle = {}, .footprint = {.front = 1.95, .half_width = 0.9}};
  control::PlanCheck check_{check_settings_, profile_};
  PlannerSettings settings_{.period = 50ms, .deadline = 50ms, .command_delay = 100ms, .vehicle = {}};
  Planner planner_{settings_, controller_, profile_, [this] { return clock_; }, &check_};
  Snapshot known_;
};

TEST_F(PlannerTest, PlanBeginsWhereVehicleAndObstaclesAreWhenTheCommandActs) {
  const std::vector<control::Obstacle> seen{{.X = 60.0, .Y = 1.0, .velocity_X = 2.0, .velocity_Y = -1.0}};
  known_.obstacles = seen;
  known_.obstacle_age = 30ms;
  known_.state.timestamp = known_.now - 20ms;
  ASSERT_TRUE(Plan(PlanRequest::kFirst, false, {0.0, 1.0}).accepted);
  EXPECT_NEAR(controller_.z[control::kX], 10.0 + 10.0 * 0.12 + 0.5 * 0.12 * 0.12, 1e-9);
  ASSERT_EQ(controller_.obstacles.size(), 1U);
  EXPECT_NEAR(controller_.obstacles[0].X, 60.0 + 2.0 * 0.13, 1e-9);
  EXPECT_NEAR(controller_.obstacles[0].Y, 1.0 - 0.13, 1e-9);
  // A command acts after the delay of two periods, and until then the earlier ones do.
  for (const double speed : {10.0 + 0.07 - 2.0 * 0.05, 10.0 + 0.02 - 2.0 * 0.1}) {
    ASSERT_TRUE(Plan(PlanRequest::kNext, true, {0.0, -2.0}).accepted);
    EXPECT_NEAR(controller_.z[control::kUpsilon], speed, 1e-9);
  }
}

// A vehicle that rolls downhill, seen while the driver still drives.
TEST_F(PlannerTest, DisturbanceThatTheStatesShowIsToldToTheControllerAndActsDuringTheDelay) {
  for (const bool offset_free : {true, false}) {
    settings_.offset_free = offset_free;
    Planner planner(
        settings_, controller_, profile_, [this] { return clock_; }, &check_);
    known_.state.z << 10.0, 0.0, 10.0, 0.0, 0.0, 0.0;
    for (int i = 0; i < 60; ++i) {
      ++known_.step;
      known_.state.z[control::kX] += 0.05 * known_.state.z[control::kUpsilon];
      known_.state.z[control::kUpsilon] += 0.05 * 0.5;
      planner.StartStopwatch();
      const bool first = i == 59;
      (void)planner.Plan(first ? PlanRequest::kFirst : PlanRequest::kNone, known_, {.s = 10.0}, false,
                         Input::Zero());
    }
    EXPECT_NEAR(controller_.disturbance.a_x, offset_free ? 0.5 : 0.0, 0.05);
    EXPECT_EQ(planner.disturbance().a_x, controller_.disturbance.a_x);
    EXPECT_NEAR(controller_.z[control::kUpsilon] - known_.state.z[control::kUpsilon],
                offset_free ? 0.05 : 0.0, 5e-3);
  }
}

TEST_F(PlannerTest, AnswerOlderThanTheDeadlineBelongsToALaterStepAndLeavesTheActivePlan) {
  controller_.takes = 50ms;
  EXPECT_TRUE(Plan(PlanRequest::kFirst).accepted);
  known_.step = 101;
  known_.waited = 1ns;
  const Outcome late = Plan(PlanRequest::kNext);
  EXPECT_FALSE(late.accepted);
  EXPECT_EQ(late.step, 102);
  EXPECT_EQ(late.fault, safety::Cause::kDeadlineMissed);
  EXPECT_EQ(planner_.last_refusal(), bus::FaultCode::kDeadlineMissed);
  known_.waited = 50ms + 1ns;
  EXPECT_EQ(Plan(PlanRequest::kNext).solution, nullptr);  // The answer would be late however fast it is.
  EXPECT_EQ(planner_.refused(), 1U);
  EXPECT_EQ(planner_.active().Age(102), 2);
}

TEST_F(PlannerTest, RequestDecidesWhetherAMissingPlanIsAFaultAndTheControllerStartsAnew) {
  EXPECT_EQ(Plan(PlanRequest::kNoState).fault, std::nullopt);  // A state is there, so the route has ended.
  known_.state_new = false;
  EXPECT_EQ(Plan(PlanRequest::kNoState).fault, safety::Cause::kStateLate);
  EXPECT_EQ(Plan(PlanRequest::kNone).fault, std::nullopt);
  EXPECT_EQ(controller_.steps, 0);
  EXPECT_TRUE(Plan(PlanRequest::kFirst).accepted);
  EXPECT_TRUE(Plan(PlanRequest::kNext).accepted);
  EXPECT_EQ(controller_.resets, 1);
}

TEST_F(PlannerTest, ConstraintThatASolutionRelaxesOrThatObstructsAnUnsolvedProblemIsNamed) {
  EXPECT_FALSE(Plan(PlanRequest::kFirst).relaxation);
  controller_.plan.relaxation = {.constraint = {.kind = ConstraintKind::kState}, .amount = 0.1};
  const Outcome relaxed = Plan(PlanRequest::kNext);
  ASSERT_TRUE(relaxed.relaxation);
  EXPECT_EQ(relaxed.relaxation->constraint.kind, ConstraintKind::kState);
  controller_.plan.status = control::SolverStatus::kInfeasible;
  const Outcome unsolved = Plan(PlanRequest::kNext);
  EXPECT_EQ(unsolved.fault, safety::Cause::kSolverFailed);
  ASSERT_TRUE(unsolved.relaxation);
  EXPECT_EQ(unsolved.relaxation->constraint.kind, ConstraintKind::kRoad);
}

TEST_F(PlannerTest, PlanIntoAnObstacleIsTheLesserEvilOnlyBesideAnActivePlan) {
  EXPECT_TRUE(Plan(PlanRequest::kFirst).accepted);
  // The plan begins at X = 11 m, and the vehicle's front reaches the edge in its second step.
  const std::vector<control::Obstacle> ahead{{.X = 11.0 + 1.95 + 1.0 + 0.75}};
  known_.obstacles = ahead;
  const Outcome lesser_evil = Plan(PlanRequest::kNext);
  EXPECT_TRUE(lesser_evil.accepted);
  ASSERT_TRUE(lesser_evil.rejection);
  EXPECT_EQ(lesser_evil.rejection->constraint.step, 2);
  planner_.Forget();
  EXPECT_EQ(Plan(PlanRequest::kFirst).fault, safety::Cause::kPlanRejected);
}

TEST_F(PlannerTest, IterationMayBeginWithinAQuarterOfTheDeadline) {
  for (const auto takes : {12499us, 12500us}) {
    controller_.takes = takes;
    EXPECT_TRUE(Plan(PlanRequest::kFirst).accepted);
    EXPECT_EQ(controller_.time_left, takes < 12500us);
  }
}

}  // namespace
}  // namespace loop
