// The control loop as configured for lpv-affine: by progress, with a plan check and a delay between command and effect.
#include <gtest/gtest.h>

#include "loop/control_loop.hpp"
#include "tests/bus/bus_frames.hpp"
#include "tests/loop/fake_controller.hpp"

namespace loop {
namespace {

using namespace std::chrono_literals;
using control::ConstraintKind;

constexpr double kPeriod = 0.05, kSpeed = 10.0;
constexpr control::RoadBounds kRoad{.left = 4.0, .right = -4.0};
// Distance from the vehicle to the centre of an obstacle of radius 1 m whose edge its front reaches in step 3 [m].
constexpr double kThirdStep = 1.95 + 1.0 + 2.5 * kPeriod * kSpeed;

LoopSettings Settings(base::Time command_delay) {
  LoopSettings settings;
  settings.command_delay = command_delay;
  return settings;
}

class DrivingLoopTest : public testing::Test {
 protected:
  explicit DrivingLoopTest(base::Time command_delay = {}) : settings_(Settings(command_delay)) {}

  struct Sent {
    bus::SteeringCommand steering;
    bus::ConstraintReport constraint;
  };

  template <typename T>
  T Decode(const can::Frame& frame) const {
    return std::get<T>(*bus_.Decode(frame.id, frame.Payload()));
  }
  Sent Period() {
    now_ += 50ms;
    vehicle_.pose.X += kPeriod * vehicle_.motion.upsilon;
    Sent sent;
    for (const can::Frame& frame : vehicle_.All()) {
      if (!loop_.Receive(frame, now_)) continue;
      const auto frames = loop_.Cycle(now_, Trigger::kState);
      sent = {.steering = Decode<bus::SteeringCommand>(frames[0]),
              .constraint = Decode<bus::ConstraintReport>(frames[5])};
    }
    return sent;
  }
  Sent Engage() {
    for (int i = 0; i < 5; ++i) Period();
    vehicle_.request.engage = true;
    return Period();
  }
  // Puts an obstacle `ahead` [m] of the vehicle's position in the next period.
  void PutObstacle(double ahead) {
    vehicle_.obstacles = {{.object_id = 63, .X = vehicle_.pose.X + kPeriod * kSpeed + ahead, .Y = 0.0}};
  }
  // Makes the next plans go straight on.
  void PlanStraight() { controller_.Plan({0.0, 0.0}); }

  bus::VehicleBus bus_;
  FakeController controller_;
  control::TimeReference reference_{StraightRoute(), kPeriod};
  control::RoadProfile profile_{StraightOn(), kRoad, {}};
  control::PlanCheck check_{{.vehicle = {},
                             .footprint = {.front = 1.95, .rear = 2.3, .half_width = 0.9},
                             .mu = 0.7,
                             .t_s = kPeriod},
                            profile_};
  LoopSettings settings_;
  ProgressController by_progress_{controller_, reference_};
  ControlLoop loop_{settings_, bus_, by_progress_, reference_, profile_, [] { return base::Time{}; },
                    &check_};
  bus::FakeVehicle vehicle_{bus_};
  base::Time now_ = 10s;
};

TEST_F(DrivingLoopTest, PlanIntoAnObstacleDoesNotEngageAndTheBusTellsWhich) {
  PlanStraight();
  for (int i = 0; i < 5; ++i) Period();
  vehicle_.request.engage = true;
  PutObstacle(kThirdStep);
  const Sent sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kStandby);
  EXPECT_EQ(controller_.steps, 1);
  EXPECT_EQ(sent.constraint.verdict, bus::ConstraintVerdict::kRejected);
  EXPECT_EQ(sent.constraint.constraint, bus::ConstraintName::kObstacle);
  EXPECT_EQ(sent.constraint.index, 63);
  EXPECT_EQ(sent.constraint.step, 3);
  EXPECT_GT(sent.constraint.amount, 0.0);
}

TEST_F(DrivingLoopTest, PlanOffTheRoadIsRejectedAndTheLastGoodOneGoesOn) {
  PlanStraight();
  ASSERT_EQ(Engage().steering.mode, bus::Mode::kActive);
  vehicle_.pose.Y = 3.05;  // 5 cm from the edge
  controller_.Plan({0.3, 0.0});
  const Sent sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kDegraded);
  EXPECT_EQ(sent.steering.plan_age, 1);
  EXPECT_NEAR(sent.steering.delta, 0.0, 1e-6);
  EXPECT_EQ(sent.constraint.verdict, bus::ConstraintVerdict::kRejected);
  EXPECT_EQ(sent.constraint.constraint, bus::ConstraintName::kRoad);
  EXPECT_EQ(loop_.report().plans_refused, 1);
  EXPECT_EQ(loop_.report().last_refusal, bus::FaultCode::kPlanRejected);

  PlanStraight();
  EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);
}

TEST_F(DrivingLoopTest, RejectedForLongTheVehicleIsStopped) {
  PlanStraight();
  Engage();
  vehicle_.pose.Y = 3.05;
  controller_.Plan({0.3, 0.0});
  Sent sent;
  for (int i = 1; i <= FakeController::kHorizon; ++i) sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(loop_.report().fault, bus::FaultCode::kPlanExhausted);
  EXPECT_EQ(loop_.report().last_refusal, bus::FaultCode::kPlanRejected);
}

TEST_F(DrivingLoopTest, LesserEvilIsFollowedAndReported) {
  PlanStraight();
  Engage();
  PutObstacle(kThirdStep);
  controller_.Plan({0.0, -1.0});  // touches it too, but no earlier than the active plan
  const Sent sent = Period();
  EXPECT_EQ(sent.steering.mode, bus::Mode::kActive);
  EXPECT_EQ(sent.steering.plan_age, 0);
  EXPECT_EQ(sent.constraint.verdict, bus::ConstraintVerdict::kRelaxed);
  EXPECT_EQ(sent.constraint.constraint, bus::ConstraintName::kObstacle);
  EXPECT_EQ(loop_.report().plans_refused, 0);
}

TEST_F(DrivingLoopTest, VehicleThatIsLateIsNotDragged) {
  PlanStraight();
  Engage();
  vehicle_.motion.upsilon = 5.0;
  for (int i = 0; i < 40; ++i) Period();
  EXPECT_EQ(loop_.report().mode, bus::Mode::kActive);
  EXPECT_NEAR(controller_.first_reference[control::kX], vehicle_.pose.X, 2.0 * kPeriod * kSpeed);
}

TEST_F(DrivingLoopTest, DriveEndsWhereTheRouteDoesWithTheVehicleAtRest) {
  PlanStraight();
  vehicle_.pose.X = 90.0;
  Engage();
  while (vehicle_.pose.X < 99.0) EXPECT_EQ(Period().steering.mode, bus::Mode::kActive) << vehicle_.pose.X;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);  // at the end, but not at rest
  vehicle_.motion.upsilon = 0.0;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
  EXPECT_EQ(loop_.report().cause, safety::Cause::kRouteEnd);
  EXPECT_EQ(loop_.report().fault, bus::FaultCode::kRouteEnd);
}

class DelayedLoopTest : public DrivingLoopTest {
 protected:
  DelayedLoopTest() : DrivingLoopTest(60ms) {}
};

TEST_F(DelayedLoopTest, PlanBeginsWhereTheCommandActs) {
  PlanStraight();
  ASSERT_EQ(Engage().steering.mode, bus::Mode::kActive);
  EXPECT_NEAR(controller_.z[control::kX], vehicle_.pose.X + 0.06 * kSpeed, 2e-3);
  // Commands that have not acted yet are taken into account.
  controller_.Plan({0.0, -0.5});
  for (int i = 0; i < 5; ++i) Period();
  EXPECT_NEAR(controller_.z[control::kUpsilon], kSpeed - 0.06 * 0.5, 1e-3);
}

}  // namespace
}  // namespace loop
