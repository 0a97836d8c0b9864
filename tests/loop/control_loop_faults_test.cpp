#include <cmath>

#include "tests/loop/control_loop_fixture.hpp"

namespace loop {
namespace {

TEST_F(ControlLoopTest, StandstillThatIsNoLongerFreshEndsNoStop) {
  Engage();
  vehicle_.motion.upsilon = 0.1;
  Period();
  for (int i = 0; i < 10; ++i) {
    TimerPeriod();
  }
  EXPECT_EQ(loop_.report().mode, bus::Mode::kSafeStop);
}

TEST_F(ControlLoopTest, FailedSolveIsAnsweredFromTheLastPlanAndThenByAStop) {
  Engage();
  controller_.status = control::SolverStatus::kInfeasible;
  for (int age = 1; age < FakeController::kHorizon; ++age) {
    const Sent sent = Period();
    EXPECT_EQ(sent.steering.mode, bus::Mode::kDegraded);
    EXPECT_EQ(sent.steering.plan_age, age);
    EXPECT_NEAR(sent.steering.delta, 0.01 * (age + 1), 1e-6);
    EXPECT_NEAR(sent.acceleration.acceleration, -0.1 * (age + 1), 1e-4);
    EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kSolverInfeasible);
    EXPECT_EQ(sent.status.solver_status, bus::SolverStatus::kInfeasible);
    EXPECT_EQ(sent.frames, kWithoutHorizon);
    EXPECT_EQ(sent.diagnostics.cause, bus::ModeCause::kSolverFailed);
    EXPECT_EQ(sent.diagnostics.previous_mode, bus::Mode::kActive);
    EXPECT_NEAR(sent.diagnostics.countdown, 0.05 * (FakeController::kHorizon - 1 - age), 1e-9);
    EXPECT_EQ(sent.diagnostics.plans_refused, age);
  }
  double a = -0.1 * FakeController::kHorizon;
  for (int i = 0; i < 5; ++i) {
    const Sent sent = Period();
    EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
    EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kPlanExhausted);
    EXPECT_NEAR(sent.diagnostics.countdown, 0.0, 1e-9);
    EXPECT_NEAR(sent.steering.delta, std::max(0.0, 0.04 - 0.025 * (i + 1)),
                1e-3);            // to the path, straight on
    a = std::max(-3.0, a - 1.5);  // no jump
    EXPECT_NEAR(sent.acceleration.acceleration, a, 1e-4);
  }
}

TEST_F(ControlLoopTest, GoodSolveAfterFailedOnesGoesOn) {
  Engage();
  controller_.status = control::SolverStatus::kIterationLimit;
  EXPECT_EQ(Period().status.fault_code, bus::FaultCode::kSolverIterationLimit);
  controller_.status = control::SolverStatus::kNumericalFailure;
  EXPECT_EQ(Period().status.fault_code, bus::FaultCode::kSolverNumericalFailure);
  controller_.status = control::SolverStatus::kSolved;
  const Sent sent = Period();
  EXPECT_EQ(sent.steering.plan_age, 0);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kNone);
}

TEST_F(ControlLoopTest, PlanWithANanIsRefused) {
  Engage();
  controller_.poison = true;
  const Sent sent = Period();
  EXPECT_EQ(sent.steering.plan_age, 1);
  EXPECT_EQ(sent.steering.mode, bus::Mode::kDegraded);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kPlanRejected);
  EXPECT_EQ(loop_.report().plans_refused, 1U);
  controller_.poison = false;
  controller_.poison_input = true;
  EXPECT_EQ(Period().steering.plan_age, 2);
  EXPECT_EQ(loop_.report().plans_refused, 2U);
}

TEST_F(ControlLoopTest, WithoutAFirstPlanItDoesNotEngage) {
  controller_.status = control::SolverStatus::kInfeasible;
  const Sent sent = Engage();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kStandby);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kSolverInfeasible);
  EXPECT_TRUE(loop_.report().engagement_refused);
}

TEST_F(ControlLoopTest, MissingStateIsPredictedAndThenStopsTheVehicle) {
  Engage();
  const double last = controller_.z[control::kX];
  for (int age = 1; age <= 6; ++age) {
    const Sent sent = TimerPeriod();
    EXPECT_EQ(sent.steering.mode, bus::Mode::kDegraded);
    EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kStateLate);
    EXPECT_EQ(sent.steering.plan_age, 0);
    EXPECT_EQ(sent.steering.state_counter, 15);
    // At 10 m/s, with the accelerations of −0.1 m/s² that were commanded.
    const double t = 0.05 * age;
    EXPECT_NEAR(controller_.z[control::kX], last + 10.0 * t - 0.05 * t * t, 0.01);
  }
  Sent sent = TimerPeriod();  // the state is older than 0.3 s now
  EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kStateStale);
  for (int i = 0; i < 100; ++i) {
    sent = TimerPeriod();
    EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);  // brakes as long as nobody says that it stands
    EXPECT_NEAR(sent.acceleration.acceleration, -3.0, i == 0 ? 1.5 : 1e-4);
  }
}

TEST_F(ControlLoopTest, CorruptedStateStopsTheVehicleAndIsNamed) {
  Engage();
  Sent sent;
  for (int i = 0; i < 7; ++i) {
    Advance();
    Give(vehicle_.Request());
    Give(vehicle_.Obstacles());
    auto frames = vehicle_.State();
    frames[1].data[4] ^= std::byte{1};
    EXPECT_EQ(Give(frames).frames, 0U);
    sent = Read(loop_.Cycle(now_, Trigger::kTimer));
  }
  EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kStateInvalid);
  EXPECT_EQ(sent.diagnostics.faulty_message, 2);  // VehicleMotion
  EXPECT_EQ(sent.diagnostics.frame_fault, 4);     // WrongCrc
}

TEST_F(ControlLoopTest, MessageThatStaysAwayIsNamedWithoutAFrameFault) {
  EXPECT_EQ(Engage().diagnostics.faulty_message, 0);
  for (int i = 0; i < 4; ++i) {
    Advance();
    Give(vehicle_.Obstacles());
    Give(vehicle_.State());
  }
  ASSERT_TRUE(loop_.report().faulty_message);
  EXPECT_EQ(loop_.report().faulty_message->message, safety::RxMessage::kDriverRequest);
  EXPECT_EQ(loop_.report().faulty_message->reason, std::nullopt);
  EXPECT_EQ(Period().diagnostics.faulty_message, 0);
}

// One after another: healthy for three periods, then stale; so long in Degraded, then a stop.
TEST_F(ControlLoopTest, StaleObstaclesAreDoneWithoutForASecondThenTheVehicleIsStopped) {
  Engage();
  for (int i = 0; i < 24; ++i) {
    Advance();
    Give(vehicle_.Request());
    const Sent sent = Give(vehicle_.State());
    EXPECT_EQ(sent.steering.mode, i < 3    ? bus::Mode::kActive
                                  : i < 23 ? bus::Mode::kDegraded
                                           : bus::Mode::kSafeStop)
        << i;
    EXPECT_EQ(sent.status.fault_code, i < 3 ? bus::FaultCode::kNone : bus::FaultCode::kObstaclesStale);
    if (i >= 3) {
      EXPECT_NEAR(sent.diagnostics.countdown, std::max(0.05 * (22 - i), 0.0), 1e-9);
    }
    if (i < 23) {
      EXPECT_EQ(sent.steering.plan_age, 0);  // plans go on
    }
  }
}

TEST_F(ControlLoopTest, StaleRequestIsDoneWithoutForASecondThenTheVehicleIsStopped) {
  Engage();
  Sent sent;
  for (int i = 0; i < 23; ++i) {
    Advance();
    Give(vehicle_.Obstacles());
    sent = Give(vehicle_.State());
  }
  EXPECT_EQ(sent.steering.mode, bus::Mode::kDegraded);
  Advance();
  Give(vehicle_.Obstacles());
  sent = Give(vehicle_.State());
  EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kDriverRequestStale);
}

TEST_F(ControlLoopTest, RequestThatComesBackInTimeEndsDegraded) {
  Engage();
  for (int i = 0; i < 10; ++i) {
    Advance();
    Give(vehicle_.Obstacles());
    Give(vehicle_.State());
  }
  EXPECT_EQ(loop_.report().mode, bus::Mode::kDegraded);
  EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);
  EXPECT_EQ(loop_.report().cause, safety::Cause::kRecovered);
}

TEST_F(ControlLoopTest, SafeStopEndsAtOnceWhenTheDriverTakesOver) {
  for (const bool brake : {true, false}) {
    Engage();
    controller_.status = control::SolverStatus::kInfeasible;
    for (int i = 0; i < 5; ++i) Period();
    EXPECT_EQ(loop_.report().mode, bus::Mode::kSafeStop);
    vehicle_.request = {.engage = brake, .brake = brake};
    EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
    EXPECT_EQ(loop_.report().cause, brake ? safety::Cause::kOverride : safety::Cause::kReleased);
    controller_.status = control::SolverStatus::kSolved;
    vehicle_.request = {};
  }
}

TEST_F(ControlLoopTest, SafeStopFollowsThePathOfThePlanAndIsHeldAtStandstillForAWhile) {
  Engage();
  controller_.status = control::SolverStatus::kInfeasible;
  loop_.SetBusUp(false);
  Sent sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kBusDown);
  loop_.SetBusUp(true);
  sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
  EXPECT_NEAR(sent.steering.delta, 0.0, 0.01);  // the path is straight, whatever the inputs were
  vehicle_.motion.upsilon = 0.1;
  const double held = sent.steering.delta;
  for (int i = 0; i < 40; ++i) {
    sent = Period();
    EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop) << i;
    EXPECT_NEAR(sent.steering.delta, held, 1e-9) << i;
    EXPECT_LT(sent.acceleration.acceleration, 0.0) << i;
  }
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
  EXPECT_EQ(loop_.report().cause, safety::Cause::kStandstill);
}

TEST_F(ControlLoopTest, WhenItsCauseIsGoneTheStopEndsAndTheVehicleDrivesOn) {
  for (const double speed : {8.0, 0.1}) {  // while it stops, and held at standstill
    vehicle_.request.engage = false;
    vehicle_.motion.upsilon = 10.0;
    Engage();
    loop_.SetBusUp(false);
    EXPECT_EQ(Period().steering.mode, bus::Mode::kSafeStop);
    loop_.SetBusUp(true);
    vehicle_.motion.upsilon = speed;
    EXPECT_EQ(Period().steering.mode, bus::Mode::kSafeStop);
    EXPECT_EQ(Period().steering.mode, bus::Mode::kSafeStop);
    EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);
    EXPECT_EQ(loop_.report().cause, safety::Cause::kRecovered);
    EXPECT_EQ(loop_.report().plan_age, 0);
  }
}

TEST_F(ControlLoopTest, BusThatWasAwayForLongFindsNoCommandEnabled) {
  Engage();
  loop_.SetBusUp(false);
  for (int i = 0; i < 39; ++i) {
    EXPECT_EQ(TimerPeriod().steering.mode, bus::Mode::kSafeStop);
  }
  Sent sent;
  for (int i = 0; i < 5; ++i) {
    sent = TimerPeriod();
  }
  EXPECT_EQ(sent.steering.mode, bus::Mode::kFault);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kBusDown);
  loop_.SetBusUp(true);
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(Period().steering.enable);  // the request is still held
  }
  vehicle_.request.engage = false;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
  Period();
  vehicle_.request.engage = true;
  EXPECT_TRUE(Period().steering.enable);
}

TEST_F(ControlLoopTest, DaemonThatStoodStillForLongEnablesNoCommand) {
  Engage();
  now_ += 10s;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(Period().steering.mode, bus::Mode::kFault);
  }
}

TEST_F(ControlLoopTest, PlanThatComesTooLateIsNotUsedAndTheLastOneGoesOn) {
  Engage();
  stopwatch_step_ = 51ms;  // a period later: the command is that of the step that it is by now
  Sent sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kDegraded);
  EXPECT_EQ(sent.steering.plan_age, 2);
  EXPECT_EQ(sent.steering.state_counter, 15);
  EXPECT_NEAR(sent.steering.delta, 0.03, 1e-6);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kDeadlineMissed);
  EXPECT_EQ(sent.status.deadline_misses, 1);
  EXPECT_EQ(sent.frames, kWithoutHorizon);
  stopwatch_step_ = 30ms;
  sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kActive);
  EXPECT_EQ(sent.steering.plan_age, 0);
  EXPECT_EQ(sent.status.deadline_misses, 1);
  EXPECT_NEAR(sent.status.solve_time, 0.03, 1e-6);
}

TEST_F(ControlLoopTest, StateThatHasWaitedTooLongGetsNoAnswerAndNoPlan) {
  Engage();
  const int steps = controller_.steps;
  Advance();
  Sent sent;
  for (const can::Frame& frame : vehicle_.All()) {
    if (loop_.Receive(frame, now_)) sent = Read(loop_.Cycle(now_ + 60ms, Trigger::kState));
  }
  EXPECT_EQ(controller_.steps, steps);
  EXPECT_EQ(sent.steering.state_counter, 15);
  EXPECT_EQ(sent.steering.plan_age, 2);
  EXPECT_EQ(sent.status.deadline_misses, 1);
}

TEST_F(ControlLoopTest, WaitingAndPlanningTogetherMayNotPassTheDeadline) {
  Engage();
  stopwatch_step_ = 30ms;
  Advance();
  Sent sent;
  for (const can::Frame& frame : vehicle_.All()) {
    if (loop_.Receive(frame, now_)) sent = Read(loop_.Cycle(now_ + 30ms, Trigger::kState));
  }
  EXPECT_EQ(sent.status.deadline_misses, 1);
  EXPECT_EQ(sent.steering.plan_age, 2);
}

TEST_F(ControlLoopTest, LatePlanDoesNotEngage) {
  for (int i = 0; i < 5; ++i) Period();
  vehicle_.request.engage = true;
  stopwatch_step_ = 51ms;
  const Sent sent = Period();
  EXPECT_FALSE(sent.steering.enable);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kDeadlineMissed);
}

}  // namespace
}  // namespace loop
