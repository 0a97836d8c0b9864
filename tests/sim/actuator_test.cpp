#include "sim/actuator.hpp"

#include <cmath>

#include "gtest/gtest.h"

namespace sim {
namespace {

TEST(Actuator, WithoutLagFollowsAtOnce) {
  Actuator actuator({}, 1.0);
  actuator.Command(3.0);
  actuator.Advance(1e-3);
  EXPECT_EQ(actuator.value(), 3.0);
}

TEST(Actuator, LagIsExponential) {
  Actuator actuator({.time_constant = 0.1}, 0.0);
  actuator.Command(2.0);
  actuator.Advance(0.1);
  EXPECT_NEAR(actuator.value(), 2.0 * (1.0 - std::exp(-1.0)), 1e-12);
}

TEST(Actuator, RateAndLagTogetherAreExactWhateverTheStep) {
  const ActuatorParameters parameters{.time_constant = 0.1, .rate = 5.0};
  Actuator once(parameters, 0.0);
  Actuator often(parameters, 0.0);
  once.Command(2.0);
  often.Command(2.0);
  once.Advance(0.5);
  for (int i = 0; i < 500; ++i) often.Advance(1e-3);
  // Rate-limited until 0.5 is left after 0.3 s, then exponential.
  EXPECT_NEAR(once.value(), 2.0 - 0.5 * std::exp(-2.0), 1e-12);
  EXPECT_NEAR(often.value(), once.value(), 1e-12);
}

TEST(Actuator, OverrideActsAtOnceAndDropsTheCommandsOnTheirWay) {
  Actuator actuator({.delay_cycles = 2}, 0.0);
  actuator.Command(5.0);
  actuator.Override(1.0);
  actuator.Advance(1e-3);
  EXPECT_EQ(actuator.value(), 1.0);
  for (const double expected : {1.0, 1.0, 3.0}) {
    actuator.Command(3.0);
    actuator.Advance(1e-3);
    EXPECT_EQ(actuator.value(), expected);
  }
}

TEST(Actuator, RateIsNeverExceeded) {
  Actuator actuator({.time_constant = 0.02, .rate = 0.5}, 0.0);
  double before = 0.0;
  for (int i = 0; i < 400; ++i) {
    if (i % 40 == 0) actuator.Command(i % 80 == 0 ? 1.0 : -1.0);
    actuator.Advance(1e-3);
    EXPECT_LE(std::abs(actuator.value() - before), 0.5e-3 + 1e-12);
    before = actuator.value();
  }
}

TEST(Actuator, RateWithoutLagReachesTheTargetAndStops) {
  Actuator actuator({.rate = 2.0}, 0.0);
  actuator.Command(-1.0);
  actuator.Advance(0.25);
  EXPECT_NEAR(actuator.value(), -0.5, 1e-12);
  actuator.Advance(0.5);
  EXPECT_EQ(actuator.value(), -1.0);
}

TEST(Actuator, CommandIsHeldWithinTheRange) {
  Actuator actuator({.min = -6.0, .max = 2.0}, 0.0);
  actuator.Command(5.0);
  actuator.Advance(0.05);
  EXPECT_EQ(actuator.value(), 2.0);
  actuator.Command(-50.0);
  actuator.Advance(0.05);
  EXPECT_EQ(actuator.value(), -6.0);
}

TEST(Actuator, CommandArrivesAfterTheDelay) {
  Actuator actuator({.delay_cycles = 2}, 0.0);
  double command = 0.0;
  for (const double expected : {0.0, 0.0, 1.0, 2.0, 3.0}) {
    actuator.Command(command += 1.0);
    actuator.Advance(0.05);
    EXPECT_EQ(actuator.value(), expected);
  }
}

}  // namespace
}  // namespace sim
