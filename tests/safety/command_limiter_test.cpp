#include "safety/command_limiter.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

namespace safety {
namespace {

static_assert(!std::is_default_constructible_v<LimitedCommand>);
static_assert(!std::is_constructible_v<LimitedCommand, control::Input>, "only a limiter makes one");

TEST(CommandLimiter, CommandWithinAllLimitsPassesUnchanged) {
  const CommandLimiter limiter({});
  const control::Input wanted(0.1, -1.0);
  const LimitResult result = limiter.Limit(wanted, control::Input(0.05, -0.5), 0);
  EXPECT_EQ(result.status, LimitStatus::kPassed);
  EXPECT_EQ(result.command->u(), wanted);
}

TEST(CommandLimiter, LimitsAreThoseOfThePaper) {
  const CommandLimits limits;
  EXPECT_DOUBLE_EQ(limits.max_steering, 0.59341194567807209);       // 34°
  EXPECT_DOUBLE_EQ(limits.max_steering_step, 0.43633231299858238);  // 25°
  EXPECT_EQ(limits.min_acceleration, -6.0);
  EXPECT_EQ(limits.max_acceleration, 2.0);
  EXPECT_EQ(limits.max_acceleration_step, 1.5);
}

// The limited command, and the limits that act; all others do not.
struct Limited {
  control::Input wanted;
  control::Input applied;
  control::Input command;
  bool steering_range = false;
  bool steering_rate = false;
  bool acceleration_range = false;
  bool acceleration_rate = false;
};

TEST(CommandLimiter, EachLimitIsHeldInBothDirectionsAndNamed) {
  const CommandLimits l;
  const std::vector<Limited> cases{
      {.wanted = {1.0, 0.0}, .applied = {0.5, 0.0}, .command = {l.max_steering, 0.0}, .steering_range = true},
      {.wanted = {-1.0, 0.0},
       .applied = {-0.5, 0.0},
       .command = {-l.max_steering, 0.0},
       .steering_range = true},
      {.wanted = {0.5, 0.0},
       .applied = {-0.2, 0.0},
       .command = {-0.2 + l.max_steering_step, 0.0},
       .steering_rate = true},
      {.wanted = {-0.5, 0.0},
       .applied = {0.2, 0.0},
       .command = {0.2 - l.max_steering_step, 0.0},
       .steering_rate = true},
      {.wanted = {0.0, 9.0}, .applied = {0.0, 1.0}, .command = {0.0, 2.0}, .acceleration_range = true},
      {.wanted = {0.0, -9.0}, .applied = {0.0, -5.0}, .command = {0.0, -6.0}, .acceleration_range = true},
      {.wanted = {0.0, 1.0}, .applied = {0.0, -1.0}, .command = {0.0, 0.5}, .acceleration_rate = true},
      {.wanted = {0.0, -3.0}, .applied = {0.0, 0.0}, .command = {0.0, -1.5}, .acceleration_rate = true},
  };
  for (const Limited& c : cases) {
    const LimitResult result = CommandLimiter(l).Limit(c.wanted, c.applied, 0);
    EXPECT_EQ(result.status, LimitStatus::kLimited);
    EXPECT_EQ(result.command->u(), c.command);
    EXPECT_EQ(result.command->steering(), c.command[control::kDelta]);
    EXPECT_EQ(result.command->acceleration(), c.command[control::kAcceleration]);
    EXPECT_EQ(result.steering_range, c.steering_range);
    EXPECT_EQ(result.steering_rate, c.steering_rate);
    EXPECT_EQ(result.acceleration_range, c.acceleration_range);
    EXPECT_EQ(result.acceleration_rate, c.acceleration_rate);
  }
}

TEST(CommandLimiter, CommandAtALimitPassesUnchanged) {
  const CommandLimits l;
  for (const control::Input& u : {control::Input(l.max_steering, l.max_acceleration),
                                  control::Input(-l.max_steering, l.min_acceleration)}) {
    EXPECT_EQ(CommandLimiter(l).Limit(u, u, 0).status, LimitStatus::kPassed);
  }
}

TEST(CommandLimiter, ValueThatIsNotFiniteIsRefused) {
  const CommandLimiter limiter({});
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    for (const control::Input& u : {control::Input(bad, 0.0), control::Input(0.0, bad)}) {
      EXPECT_EQ(limiter.Limit(u, control::Input::Zero(), 0).status, LimitStatus::kNotFinite);
      EXPECT_FALSE(limiter.Limit(u, control::Input::Zero(), 0).command);
      EXPECT_EQ(limiter.Limit(control::Input::Zero(), u, 0).status, LimitStatus::kNotFinite);
    }
  }
}

TEST(CommandLimiter, CommandOfAnOldPlanIsRefused) {
  const CommandLimiter limiter({.max_age = 7});
  EXPECT_TRUE(limiter.Limit(control::Input::Zero(), control::Input::Zero(), 7).command);
  for (const int age : {8, 1000, -1}) {
    EXPECT_EQ(limiter.Limit(control::Input::Zero(), control::Input::Zero(), age).status,
              LimitStatus::kTooOld);
    EXPECT_FALSE(limiter.Limit(control::Input::Zero(), control::Input::Zero(), age).command);
  }
}

TEST(CommandLimiter, RangeAndRateHoldForAnyInput) {
  const CommandLimits l;
  const CommandLimiter limiter(l);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> any(-20.0, 20.0);
  control::Input applied = control::Input::Zero();
  for (int i = 0; i < 10000; ++i) {
    const control::Input u = limiter.Limit({any(generator), any(generator)}, applied, 0).command->u();
    EXPECT_LE(std::abs(u[control::kDelta]), l.max_steering);
    EXPECT_LE(std::abs(u[control::kDelta] - applied[control::kDelta]), l.max_steering_step + 1e-12);
    EXPECT_GE(u[control::kAcceleration], l.min_acceleration);
    EXPECT_LE(u[control::kAcceleration], l.max_acceleration);
    EXPECT_LE(std::abs(u[control::kAcceleration] - applied[control::kAcceleration]),
              l.max_acceleration_step + 1e-12);
    applied = u;
  }
}

TEST(CommandLimiter, AfterACommandOutOfRangeTheRangeWins) {
  const CommandLimits l;
  LimitResult result = CommandLimiter(l).Limit({2.0, 9.0}, {3.0, 9.0}, 0);
  EXPECT_EQ(result.command->steering(), l.max_steering);
  EXPECT_EQ(result.command->acceleration(), l.max_acceleration);
  result = CommandLimiter(l).Limit({-2.0, -9.0}, {-3.0, -9.0}, 0);
  EXPECT_EQ(result.command->steering(), -l.max_steering);
  EXPECT_EQ(result.command->acceleration(), l.min_acceleration);
}

}  // namespace
}  // namespace safety
