#include "loop/command_source.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace loop {
namespace {

using control::Input;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kMade = 100;  // step of the plan

class CommandSourceTest : public testing::Test {
 protected:
  CommandSourceTest() {
    control::Plan plan;
    for (int i = 0; i < 4; ++i) plan.u.emplace_back(0.01 * (i + 1), -0.1 * (i + 1));
    plan_.Set(plan, kMade);
    state_.complete = true;
    state_.feedback = {0.3, 1.5};
  }
  safety::LimitResult Command(bus::Mode mode, std::int64_t step, const Input& applied) const {
    return source_.Command(mode, step, plan_, {0.02, -3.0}, state_, applied);
  }
  // The input of a command; it is NaN, and equal to nothing, if there is no command.
  static Input Of(const safety::LimitResult& result) {
    return result.command ? result.command->u() : Input(kNaN, kNaN);
  }
  safety::CommandLimits limits_{.max_age = 2};
  CommandSource source_{limits_};
  ActivePlan plan_{4};
  VehicleState state_;
};

TEST_F(CommandSourceTest, VehicleObeysTheMeasuredInputsUntilCommandsAreEnabledThenTheLastCommand) {
  state_.complete = false;
  EXPECT_EQ(source_.Applied(state_, false), Input::Zero());  // Nothing has been measured yet.
  state_.complete = true;
  EXPECT_EQ(source_.Applied(state_, false), state_.feedback);
  const auto result = Command(bus::Mode::kActive, kMade + 1, Input::Zero());
  ASSERT_TRUE(result.command);
  EXPECT_EQ(source_.Applied(state_, true), Input::Zero());  // A command counts once it has been sent.
  if (result.command) source_.Apply(*result.command);
  EXPECT_EQ(source_.Applied(state_, true), Input(0.02, -0.2));
  EXPECT_EQ(source_.Applied(state_, false), state_.feedback);
}

TEST_F(CommandSourceTest, DrivingSendsTheInputOfTheStepUnlessThePlanIsTooOld) {
  for (const auto mode : {bus::Mode::kActive, bus::Mode::kDegraded}) {
    for (int i = 0; i <= limits_.max_age; ++i) {
      const auto result = Command(mode, kMade + i, Input::Zero());
      EXPECT_EQ(result.status, safety::LimitStatus::kPassed);
      EXPECT_EQ(Of(result), Input(0.01 * (i + 1), -0.1 * (i + 1)));
    }
    const auto too_old = Command(mode, kMade + limits_.max_age + 1, Input::Zero());
    EXPECT_EQ(too_old.status, safety::LimitStatus::kTooOld);
    EXPECT_FALSE(too_old.command);
  }
}

TEST_F(CommandSourceTest, DrivingAndStoppingChangeTheAppliedInputsNoFasterThanTheLimits) {
  const auto driving = Command(bus::Mode::kActive, kMade, {-0.5, 2.0});
  EXPECT_EQ(driving.status, safety::LimitStatus::kLimited);
  EXPECT_NEAR(Of(driving)[control::kDelta], -0.5 + limits_.max_steering_step, 1e-12);
  EXPECT_NEAR(Of(driving)[control::kAcceleration], 2.0 - limits_.max_acceleration_step, 1e-12);
  const auto stopping = Command(bus::Mode::kSafeStop, kMade, {0.0, 1.0});
  EXPECT_NEAR(Of(stopping)[control::kAcceleration], 1.0 - limits_.max_acceleration_step, 1e-12);
}

TEST_F(CommandSourceTest, StopSendsItsInputHoweverOldThePlanIs) {
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(Of(Command(bus::Mode::kSafeStop, kMade + i, {0.0, -2.5})), Input(0.02, -3.0)) << i;
  }
}

TEST_F(CommandSourceTest, DisabledCommandsAreTheMeasuredInputsWithinTheRange) {
  for (const auto mode : {bus::Mode::kInit, bus::Mode::kStandby, bus::Mode::kFault}) {
    state_.feedback = {0.3, 1.5};
    const auto measured = Command(mode, kMade, {-0.5, -6.0});  // This is too far away for any rate limit.
    EXPECT_EQ(measured.status, safety::LimitStatus::kPassed);
    EXPECT_EQ(Of(measured), state_.feedback);
    state_.feedback = {-1.0, -9.0};
    EXPECT_EQ(Of(Command(mode, kMade, Input::Zero())),
              Input(-limits_.max_steering, limits_.min_acceleration));
  }
  state_.feedback = {kNaN, 0.0};
  EXPECT_FALSE(source_.Measured(state_).command);
}

}  // namespace
}  // namespace loop
