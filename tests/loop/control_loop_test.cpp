#include "loop/control_loop.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "tests/bus/bus_frames.hpp"
#include "tests/loop/fake_controller.hpp"
#include "tests/support/allocations.hpp"

namespace loop {
namespace {

using namespace std::chrono_literals;

class ControlLoopTest : public testing::Test {
 protected:
  static constexpr std::size_t kWithoutHorizon = 6;  // frames of a cycle
  struct Sent {
    bus::SteeringCommand steering;
    bus::AccelerationCommand acceleration;
    bus::ControllerStatus status;
    bus::ControllerDiagnostics diagnostics;
    std::size_t frames = 0;
  };

  template <typename T>
  T Decode(const can::Frame& frame) const {
    EXPECT_EQ(bus_.Check(frame.id, frame.Payload()).verdict, bus::E2eVerdict::kOk);
    return std::get<T>(*bus_.Decode(frame.id, frame.Payload()));
  }
  // Reads what a cycle sent, and holds what holds in every cycle.
  Sent Read(std::span<const can::Frame> frames) const {
    Sent sent;
    sent.frames = frames.size();
    EXPECT_GE(frames.size(), kWithoutHorizon);
    sent.steering = Decode<bus::SteeringCommand>(frames[0]);
    sent.acceleration = Decode<bus::AccelerationCommand>(frames[1]);
    sent.status = Decode<bus::ControllerStatus>(frames[2]);
    sent.diagnostics = Decode<bus::ControllerDiagnostics>(frames[4]);
    const bool enabled = sent.steering.mode == bus::Mode::kActive ||
                         sent.steering.mode == bus::Mode::kDegraded ||
                         sent.steering.mode == bus::Mode::kSafeStop;
    EXPECT_EQ(sent.steering.enable, enabled);
    EXPECT_EQ(sent.acceleration.enable, enabled);
    EXPECT_EQ(sent.acceleration.mode, sent.steering.mode);
    EXPECT_EQ(sent.status.mode, sent.steering.mode);
    EXPECT_EQ(sent.acceleration.state_counter, sent.steering.state_counter);
    EXPECT_EQ(sent.acceleration.plan_age, sent.steering.plan_age);
    return sent;
  }
  // Gives frames to the loop; the cycle that they ask for.
  Sent Give(const std::vector<can::Frame>& frames) {
    Sent sent;
    for (const can::Frame& frame : frames) {
      if (loop_.Receive(frame, now_)) {
        sent = Read(loop_.Cycle(now_, Trigger::kState));
      }
    }
    return sent;
  }
  // One period with everything in it.
  Sent Period() {
    Advance();
    return Give(vehicle_.All());
  }
  // One period in which the state stays away.
  Sent TimerPeriod() {
    Advance();
    vehicle_.SkipState();
    EXPECT_EQ(Give(vehicle_.Request()).frames, 0U);
    EXPECT_EQ(Give(vehicle_.Obstacles()).frames, 0U);
    return Read(loop_.Cycle(now_, Trigger::kTimer));
  }
  void Advance() {
    now_ += 50ms;
    vehicle_.pose.X += 0.5;
  }
  Sent Engage() {
    for (int i = 0; i < 5; ++i) {
      Period();
    }
    EXPECT_EQ(loop_.report().mode, bus::Mode::kStandby);
    vehicle_.request.engage = true;
    return Period();
  }

  bus::VehicleBus bus_;
  FakeController controller_;
  control::TimeReference reference_{StraightRoute(), 0.05};
  base::Time stopwatch_step_ = 0ms;  // by which the stopwatch goes on each time it is read
  base::Time stopwatch_{};
  control::TimedController timed_{std::make_unique<Forwarding>(controller_), reference_, {}};
  ControlLoop loop_{{}, bus_, timed_, reference_, {}, [this] { return stopwatch_ += stopwatch_step_; }};
  bus::FakeVehicle vehicle_{bus_};
  base::Time now_ = 10s;
};

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
    EXPECT_NEAR(point.X, 12.5, 1e-3);
  }
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
  ControlLoop loop({}, bus_, timed, reference, {}, [] { return base::Time{}; });
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

TEST_F(ControlLoopTest, StandstillThatIsNoLongerFreshEndsNoStop) {
  Engage();
  vehicle_.motion.upsilon = 0.1;
  Period();
  for (int i = 0; i < 10; ++i) {
    TimerPeriod();
  }
  EXPECT_EQ(loop_.report().mode, bus::Mode::kSafeStop);
}

TEST_F(ControlLoopTest, WithdrawnRequestEndsActive) {
  Engage();
  vehicle_.request.engage = false;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
  EXPECT_EQ(loop_.report().cause, safety::Cause::kReleased);
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

TEST_F(ControlLoopTest, MissingStateIsBridgedByThePlanAndThenStopsTheVehicle) {
  Engage();
  for (int age = 1; age <= 3; ++age) {
    const Sent sent = TimerPeriod();
    EXPECT_EQ(sent.steering.mode, bus::Mode::kDegraded);
    EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kStateLate);
    EXPECT_EQ(sent.steering.plan_age, age);
    EXPECT_NEAR(sent.steering.delta, 0.01 * (age + 1), 1e-6);
  }
  Sent sent = TimerPeriod();  // the state is older than three periods now
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
  for (int i = 0; i < 4; ++i) {
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

TEST_F(ControlLoopTest, LatencyOfACycleIsPublishedInTheNext) {
  Period();
  loop_.SetCycleLatency(1234us);
  EXPECT_NEAR(Period().diagnostics.cycle_latency, 0.0012, 1e-9);
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

TEST_F(ControlLoopTest, SafeStopFollowsTheRestOfThePlanAndEndsAtStandstill) {
  Engage();
  loop_.SetBusUp(false);
  Sent sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(sent.status.fault_code, bus::FaultCode::kBusDown);
  loop_.SetBusUp(true);
  sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
  EXPECT_NEAR(sent.steering.delta, 0.02, 1e-6);  // u_1 of the plan made one cycle before
  vehicle_.motion.upsilon = 0.1;
  sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kStandby);
  EXPECT_EQ(loop_.report().cause, safety::Cause::kStandstill);
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
