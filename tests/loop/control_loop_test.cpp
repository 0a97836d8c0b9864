#include "loop/control_loop.hpp"

#include <cmath>

#include "tests/loop/control_loop_fixture.hpp"
#include "tests/support/allocations.hpp"

namespace loop {
namespace {

TEST_F(ControlLoopTest, ComesUpInInitAndCommandsNothingBeforeTheDriverAsks) {
  EXPECT_EQ(Period().steering.mode, bus::Mode::kInit);
  EXPECT_EQ(Period().steering.mode, bus::Mode::kInit);
  for (int i = 0; i < 10; ++i) {
    const Sent sent = Period();
    EXPECT_EQ(sent.steering.mode, bus::Mode::kStandby);
    EXPECT_EQ(sent.steering.plan_age, 63);
    EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kNone);
    EXPECT_EQ(sent.status.solver_status, bus::SolverStatus::kNone);
  }
  EXPECT_EQ(controller_.steps, 0);
}

TEST_F(ControlLoopTest, RequestHeldFromTheFirstFrameOnDoesNotEngage) {
  vehicle_.request.engage = true;
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(Period().steering.enable);
  }
}

TEST_F(ControlLoopTest, EngagedItSendsTheFirstInputOfANewPlanAndItsHorizon) {
  vehicle_.feedback = {.psi = 0.0, .delta = 0.02, .acceleration = -0.25};
  vehicle_.obstacles = {{.object_id = 3, .X = 60.0, .Y = 1.0}};
  const Sent sent = Engage();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kActive);
  EXPECT_EQ(sent.steering.plan_age, 0);
  EXPECT_NEAR(sent.steering.delta, 0.01, 1e-6);
  EXPECT_NEAR(sent.acceleration.acceleration, -0.1, 1e-4);
  EXPECT_EQ(sent.status.solver_status, bus::SolverStatus::kSolved);
  EXPECT_EQ(sent.status.iterations, 7);
  EXPECT_EQ(sent.frames, kWithoutHorizon + 1U + FakeController::kHorizon + 1U);

  // What the controller was given.
  EXPECT_EQ(controller_.resets, 1);
  EXPECT_EQ(controller_.obstacles, 1U);
  EXPECT_EQ(controller_.reference_size, FakeController::kHorizon + 1U);
  EXPECT_NEAR(controller_.first_reference[control::kX], vehicle_.pose.X, 1e-3);
  EXPECT_NEAR(controller_.z[control::kX], vehicle_.pose.X, 1e-3);
  EXPECT_NEAR(controller_.u_previous[control::kDelta], 0.02, 1e-4);
  EXPECT_NEAR(controller_.u_previous[control::kAcceleration], -0.25, 1e-3);

  Period();
  EXPECT_EQ(controller_.resets, 1);
  EXPECT_NEAR(controller_.u_previous[control::kDelta], 0.01, 1e-12);  // the command that was passed
}

TEST_F(ControlLoopTest, HorizonFramesCarryThePlan) {
  Engage();
  vehicle_.pose.X += 0.5;
  now_ += 50ms;
  for (const can::Frame& frame : vehicle_.All()) {
    if (!loop_.Receive(frame, now_)) continue;
    const auto frames = loop_.Cycle(now_, Trigger::kState);
    const auto header = Decode<bus::HorizonHeader>(frames[kWithoutHorizon]);
    EXPECT_EQ(header.points, FakeController::kHorizon + 1);
    EXPECT_EQ(header.state_counter, vehicle_.last_state_counter());
    EXPECT_NEAR(header.step, 0.05, 1e-9);
    const auto point = Decode<bus::HorizonPoint>(frames[kWithoutHorizon + 1 + 2]);
    EXPECT_EQ(point.index, 2);
    EXPECT_NEAR(point.X, controller_.z[control::kX] + 2 * 0.5, 1e-3);
  }
}

TEST_F(ControlLoopTest, DecisionOfThePlanIsOnTheBus) {
  controller_.manoeuvre = control::ManoeuvreStatus{.decision = control::Decision::kPass,
                                                   .reason = control::Reason::kStayingCosts,
                                                   .object = 3,
                                                   .side = control::Side::kLeft,
                                                   .left_out = 100,
                                                   .speed_limit = 12.5};
  EXPECT_EQ(Period().manoeuvre.decision, bus::ManoeuvreDecision::kNone);
  const bus::ManoeuvreStatus passes = Engage().manoeuvre;
  EXPECT_EQ(passes.decision, bus::ManoeuvreDecision::kPass);
  EXPECT_EQ(passes.reason, bus::ManoeuvreReason::kStayingCosts);
  EXPECT_EQ(passes.object_id, 3);
  EXPECT_EQ(passes.side, bus::PassingSide::kLeft);
  EXPECT_EQ(passes.left_out, 63);
  EXPECT_NEAR(passes.stop_distance, 409.5, 1e-9);
  EXPECT_NEAR(passes.speed_limit, 12.5, 0.01);

  controller_.manoeuvre = control::ManoeuvreStatus{
      .decision = control::Decision::kWait, .reason = control::Reason::kRoadTooNarrow, .stop_distance = 7.3};
  const bus::ManoeuvreStatus waits = Period().manoeuvre;
  EXPECT_EQ(waits.decision, bus::ManoeuvreDecision::kWait);
  EXPECT_EQ(waits.reason, bus::ManoeuvreReason::kRoadTooNarrow);
  EXPECT_EQ(waits.object_id, bus::ManoeuvreStatus::kNoObject);
  EXPECT_EQ(waits.side, bus::PassingSide::kUnknown);
  EXPECT_NEAR(waits.stop_distance, 7.3, 1e-9);
  EXPECT_NEAR(waits.speed_limit, 81.9, 1e-9);

  EXPECT_EQ(TimerPeriod().manoeuvre.decision, bus::ManoeuvreDecision::kWait) << "for the predicted state";
  vehicle_.request.engage = false;
  EXPECT_EQ(Period().manoeuvre.decision, bus::ManoeuvreDecision::kWait) << "the driver lets go in this cycle";
  EXPECT_EQ(Period().manoeuvre.decision, bus::ManoeuvreDecision::kNone) << "no plan was made";
}

TEST_F(ControlLoopTest, EveryCommandAnswersTheCounterOfItsState) {
  Engage();
  for (int i = 0; i < 40; ++i) {
    const Sent sent = Period();
    EXPECT_EQ(sent.steering.state_counter, vehicle_.last_state_counter());
  }
  EXPECT_EQ(TimerPeriod().steering.state_counter, 15);
}

TEST_F(ControlLoopTest, NotEngagedTheCommandsFollowTheVehicle) {
  vehicle_.feedback = {.psi = 0.0, .delta = 0.2, .acceleration = -1.5};
  const Sent sent = Period();
  EXPECT_FALSE(sent.steering.enable);
  EXPECT_NEAR(sent.steering.delta, 0.2, 1e-5);
  EXPECT_NEAR(sent.acceleration.acceleration, -1.5, 1e-3);
}

TEST_F(ControlLoopTest, ReferenceAdvancesByTheCounterOfTheStates) {
  Engage();
  const int k = loop_.report().route_index;
  Period();
  EXPECT_EQ(loop_.report().route_index, k + 1);
  Advance();
  vehicle_.SkipState();  // lost, and the timer did not notice
  Period();
  EXPECT_EQ(loop_.report().route_index, k + 3);
  TimerPeriod();
  EXPECT_EQ(loop_.report().route_index, k + 4);
  Period();
  EXPECT_EQ(loop_.report().route_index, k + 5);
  // The timer went off, and then the state came after all.
  Advance();
  Read(loop_.Cycle(now_, Trigger::kTimer));
  EXPECT_EQ(loop_.report().route_index, k + 6);
  Give(vehicle_.All());
  EXPECT_EQ(loop_.report().route_index, k + 6);
  EXPECT_NEAR(controller_.first_reference[control::kX], vehicle_.pose.X, 1e-3);
}

TEST_F(ControlLoopTest, HeadingIsGivenUnwrappedToTheReference) {
  std::vector<Eigen::Vector2d> west;
  for (int i = 0; i < 200; ++i) {
    west.emplace_back(-0.5 * i, 0.0);
  }
  const control::TimeReference reference(west, 0.05);
  control::TimedController timed(std::make_unique<Forwarding>(controller_), reference, {});
  ControlLoop loop({}, bus_, timed, reference, profile_, [] { return base::Time{}; });
  vehicle_.feedback.psi = -3.1;
  for (int i = 0; i < 8; ++i) {
    vehicle_.request.engage = i > 4;
    vehicle_.pose.X -= 0.5;
    now_ += 50ms;
    for (const can::Frame& frame : vehicle_.All()) {
      if (loop.Receive(frame, now_)) static_cast<void>(loop.Cycle(now_, Trigger::kState));
    }
  }
  ASSERT_GT(controller_.steps, 0);
  EXPECT_LT(std::abs(controller_.z[control::kPsi] - controller_.first_reference[control::kPsi]), 0.1);
}

TEST_F(ControlLoopTest, OverrideWinsWithinOneCycle) {
  Engage();
  vehicle_.request.brake = true;
  const Sent sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kStandby);
  EXPECT_EQ(loop_.report().cause, safety::Cause::kOverride);
  vehicle_.request.brake = false;
  EXPECT_FALSE(Period().steering.enable);  // asks for a new edge
  vehicle_.request.engage = false;
  Period();
  vehicle_.request.engage = true;
  EXPECT_TRUE(Period().steering.enable);
}

TEST_F(ControlLoopTest, TouchOfTheBrakeBetweenTwoCyclesIsNotLost) {
  Engage();
  vehicle_.request.steering_override = true;
  Give(vehicle_.Request());
  vehicle_.request.steering_override = false;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
}

TEST_F(ControlLoopTest, ReleaseOfTheSwitchBetweenTwoCyclesIsNotLost) {
  Engage();
  vehicle_.request.engage = false;
  Give(vehicle_.Request());
  vehicle_.request.engage = true;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
}

TEST_F(ControlLoopTest, WithdrawnRequestEndsActive) {
  Engage();
  vehicle_.request.engage = false;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
  EXPECT_EQ(loop_.report().cause, safety::Cause::kReleased);
}

TEST_F(ControlLoopTest, PlanOfAnEarlierDriveDoesNotEngage) {
  Engage();
  vehicle_.request.brake = true;
  EXPECT_EQ(Period().steering.plan_age, 0);
  vehicle_.request = {};
  EXPECT_EQ(Period().steering.plan_age, 63);
  vehicle_.request.engage = true;
  controller_.status = control::SolverStatus::kInfeasible;
  EXPECT_FALSE(Period().steering.enable);  // though the old plan is not yet used up
}

TEST_F(ControlLoopTest, LatencyOfACycleIsPublishedInTheNext) {
  Period();
  loop_.SetCycleLatency(1234us);
  EXPECT_NEAR(Period().diagnostics.cycle_latency, 0.0012, 1e-9);
}

TEST_F(ControlLoopTest, EndOfTheRouteStopsTheVehicle) {
  double countdown = Engage().diagnostics.countdown;  // less than 10 s, the length of the route
  for (int i = 0; i < 300 && loop_.report().mode == bus::Mode::kActive; ++i) {
    const Sent sent = Period();
    EXPECT_NEAR(sent.diagnostics.countdown, std::max(countdown - 0.05, 0.0), 1e-6);
    countdown = sent.diagnostics.countdown;
  }
  EXPECT_EQ(loop_.report().mode, bus::Mode::kSafeStop);
  EXPECT_EQ(loop_.report().cause, safety::Cause::kRouteEnd);
  EXPECT_EQ(loop_.report().route_index + FakeController::kHorizon, reference_.size());
}

TEST_F(ControlLoopTest, AwayFromTheRouteItDoesNotEngageAndSaysSo) {
  vehicle_.pose.Y = 50.0;
  const Sent sent = Engage();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kStandby);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kOffRoute);
  EXPECT_EQ(controller_.steps, 0);
}

TEST_F(ControlLoopTest, TooSlowItDoesNotEngage) {
  LoopSettings settings;
  settings.engage_min_speed = 3.0;
  loop_.Reconfigure(settings);
  vehicle_.motion.upsilon = 1.0;
  EXPECT_EQ(Engage().steering.mode, bus::Mode::kStandby);
}

TEST_F(ControlLoopTest, LastWordsAreNotEnabledAndNoJump) {
  Engage();
  vehicle_.feedback.delta = 0.04;
  Period();
  const auto frames = loop_.Disable();
  ASSERT_EQ(frames.size(), 2U);
  const auto steering = Decode<bus::SteeringCommand>(frames[0]);
  EXPECT_FALSE(steering.enable);
  EXPECT_EQ(steering.mode, bus::Mode::kStandby);
  EXPECT_NEAR(steering.delta, 0.04, 1e-5);
  EXPECT_FALSE(Decode<bus::AccelerationCommand>(frames[1]).enable);
}

TEST_F(ControlLoopTest, BeforeAnyStateTheTimerSendsNothingEnabled) {
  for (int i = 0; i < 5; ++i) {
    now_ += 50ms;
    const Sent sent = Read(loop_.Cycle(now_, Trigger::kTimer));
    EXPECT_EQ(sent.steering.mode, bus::Mode::kInit);
    EXPECT_EQ(sent.steering.state_counter, 15);
    EXPECT_EQ(sent.steering.delta, 0.0);
    EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kStateStale);
  }
}

TEST_F(ControlLoopTest, AnnouncingItselfIsNoCycle) {
  for (int i = 0; i < 3; ++i) {
    const auto frames = loop_.Announce();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(Decode<bus::ControllerStatus>(frames[0]).mode, bus::Mode::kInit);
  }
  EXPECT_EQ(loop_.report().cycles, 0U);
  Advance();
  for (const can::Frame& frame : vehicle_.All()) {
    if (!loop_.Receive(frame, now_)) continue;
    const can::Frame first = loop_.Cycle(now_, Trigger::kState)[0];
    EXPECT_EQ(bus_.Check(first.id, first.Payload()).counter, 0);
  }
}

TEST_F(ControlLoopTest, NothingIsAllocatedInACycle) {
  for (std::uint8_t id = 0; id < 15; ++id) {
    vehicle_.obstacles.push_back({.object_id = id, .X = 40.0 + 5.0 * id});
  }
  std::size_t allocations = 0;
  for (int i = 0; i < 36; ++i) {  // from the first on, and the driver's request with it
    Advance();
    vehicle_.request.engage = i >= 5;
    controller_.status =
        i > 5 && i % 3 == 0 ? control::SolverStatus::kInfeasible : control::SolverStatus::kSolved;
    const auto frames = vehicle_.All();
    const std::size_t before = test_support::Allocations();
    for (const can::Frame& frame : frames) {
      if (loop_.Receive(frame, now_)) static_cast<void>(loop_.Cycle(now_, Trigger::kState));
    }
    static_cast<void>(loop_.Cycle(now_, Trigger::kTimer));
    allocations += test_support::Allocations() - before;
  }
  EXPECT_TRUE(bus::Drives(loop_.report().mode));
  EXPECT_EQ(allocations, 0U);
}

TEST_F(ControlLoopTest, StatesThatNoCycleAnswersAreStepsToo) {
  Engage();
  const int place = loop_.report().route_index;
  // More than half a round of the counter.
  for (int i = 0; i < 12; ++i) {
    Advance();
    for (const can::Frame& frame : vehicle_.All()) static_cast<void>(loop_.Receive(frame, now_));
  }
  const Sent sent = Read(loop_.Cycle(now_, Trigger::kState));
  EXPECT_EQ(sent.steering.state_counter, vehicle_.last_state_counter());
  EXPECT_EQ(loop_.report().route_index, place + 12);
}

TEST_F(ControlLoopTest, OtherSettingsHoldForTheNextEngagementAndStop) {
  LoopSettings settings;
  settings.stop_deceleration = 1.0;
  settings.engage_min_speed = 10.5;
  settings.send_horizon = false;
  loop_.Reconfigure(settings);
  EXPECT_EQ(Engage().steering.mode, bus::Mode::kStandby);  // at 10 m/s
  settings.engage_min_speed = 9.5;
  loop_.Reconfigure(settings);
  vehicle_.request.engage = false;
  Period();
  EXPECT_EQ(Engage().steering.mode, bus::Mode::kActive);
  Sent sent = Period();
  const std::size_t without_horizon = sent.frames;
  for (int i = 0; i < 8; ++i) sent = TimerPeriod();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
  EXPECT_NEAR(sent.acceleration.acceleration, -1.0, 0.01);
  EXPECT_EQ(sent.frames, without_horizon);  // no new plan, no horizon
}

}  // namespace
}  // namespace loop
