#include "control/command_limiter.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <type_traits>

namespace control {
namespace {

static_assert(!std::is_default_constructible_v<LimitedCommand>);
static_assert(!std::is_constructible_v<LimitedCommand, Input>, "only a limiter makes one");

TEST(CommandLimiter, CommandWithinAllLimitsPassesUnchanged) {
  const CommandLimiter limiter({});
  const Input wanted(0.1, -1.0);
  const LimitResult result = limiter.Limit(wanted, Input(0.05, -0.5), 0);
  EXPECT_EQ(result.status, LimitStatus::kPassed);
  EXPECT_EQ(result.command->u(), wanted);
}

TEST(CommandLimiter, EachLimitIsNamed) {
  const CommandLimits limits;
  const CommandLimiter limiter(limits);
  LimitResult result = limiter.Limit({1.0, 0.0}, {limits.max_steering, 0.0}, 0);
  EXPECT_TRUE(result.steering_range && !result.steering_rate);
  EXPECT_EQ(result.command->steering(), limits.max_steering);

  result = limiter.Limit({0.5, 0.0}, {-0.2, 0.0}, 0);
  EXPECT_TRUE(result.steering_rate && !result.steering_range);
  EXPECT_DOUBLE_EQ(result.command->steering(), -0.2 + limits.max_steering_step);

  result = limiter.Limit({0.0, -9.0}, {0.0, -5.0}, 0);
  EXPECT_TRUE(result.acceleration_range && !result.acceleration_rate);
  EXPECT_EQ(result.command->acceleration(), limits.min_acceleration);

  result = limiter.Limit({0.0, -3.0}, {0.0, 0.0}, 0);
  EXPECT_TRUE(result.acceleration_rate && !result.acceleration_range);
  EXPECT_EQ(result.command->acceleration(), -limits.max_acceleration_step);
  EXPECT_EQ(result.status, LimitStatus::kLimited);
}

TEST(CommandLimiter, ValueThatIsNotFiniteIsRefused) {
  const CommandLimiter limiter({});
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    for (const Input& u : {Input(bad, 0.0), Input(0.0, bad)}) {
      EXPECT_EQ(limiter.Limit(u, Input::Zero(), 0).status, LimitStatus::kNotFinite);
      EXPECT_FALSE(limiter.Limit(u, Input::Zero(), 0).command);
      EXPECT_EQ(limiter.Limit(Input::Zero(), u, 0).status, LimitStatus::kNotFinite);
    }
  }
}

TEST(CommandLimiter, CommandOfAnOldPlanIsRefused) {
  const CommandLimiter limiter({.max_age = 7});
  EXPECT_TRUE(limiter.Limit(Input::Zero(), Input::Zero(), 7).command);
  EXPECT_EQ(limiter.Limit(Input::Zero(), Input::Zero(), 8).status, LimitStatus::kTooOld);
  EXPECT_EQ(limiter.Limit(Input::Zero(), Input::Zero(), -1).status, LimitStatus::kTooOld);
}

TEST(CommandLimiter, RangeAndRateHoldForAnyInput) {
  const CommandLimits l;
  const CommandLimiter limiter(l);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> any(-20.0, 20.0);
  Input applied = Input::Zero();
  for (int i = 0; i < 10000; ++i) {
    const Input u = limiter.Limit({any(generator), any(generator)}, applied, 0).command->u();
    EXPECT_LE(std::abs(u[kDelta]), l.max_steering);
    EXPECT_LE(std::abs(u[kDelta] - applied[kDelta]), l.max_steering_step + 1e-12);
    EXPECT_GE(u[kAcceleration], l.min_acceleration);
    EXPECT_LE(u[kAcceleration], l.max_acceleration);
    EXPECT_LE(std::abs(u[kAcceleration] - applied[kAcceleration]), l.max_acceleration_step + 1e-12);
    applied = u;
  }
}

TEST(CommandLimiter, AfterACommandOutOfRangeTheRangeWins) {
  const CommandLimits l;
  const LimitResult result = CommandLimiter(l).Limit({2.0, 9.0}, {3.0, 9.0}, 0);
  EXPECT_EQ(result.command->steering(), l.max_steering);
  EXPECT_EQ(result.command->acceleration(), l.max_acceleration);
}

}  // namespace
}  // namespace control
