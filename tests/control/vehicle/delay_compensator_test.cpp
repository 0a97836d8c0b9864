#include "control/vehicle/delay_compensator.hpp"

#include <gtest/gtest.h>

#include "control/vehicle/discrete_model.hpp"

namespace control {
namespace {

constexpr double kPeriod = 0.05;

State Moving() {
  State z;
  z << 10.0, -4.0, 15.0, 0.1, 0.3, 0.05;
  return z;
}

State Driven(State z, const Input& u, double time) {
  const int steps = 10;
  const DiscreteModel model(BlendedModel(VehicleParameters{}), time / steps);
  for (int i = 0; i < steps; ++i) z = model.Step(z, u);
  return z;
}

TEST(DelayCompensator, WithoutDelayAndAgeTheStateIsAsMeasured) {
  DelayCompensator delay({}, kPeriod, 0.0);
  delay.Record({0.1, 1.0});
  EXPECT_EQ(delay.Predict(Moving(), 0.0), Moving());
}

TEST(DelayCompensator, TheCommandOfTheCycleBeforeActsUntilTheNewOne) {
  DelayCompensator delay({}, kPeriod, 0.03);
  delay.Record({0.4, -5.0});  // no longer acts
  delay.Record({0.02, 1.0});
  const State ahead = delay.Predict(Moving(), 0.0);
  EXPECT_LT((ahead - Driven(Moving(), {0.02, 1.0}, 0.03)).norm(), 1e-4);
}

TEST(DelayCompensator, WithALongDelayEveryCommandActsInItsTurn) {
  DelayCompensator delay({}, kPeriod, 0.12);
  const Input first(0.03, 1.0), second(-0.01, -1.0), third(0.02, 0.5);
  for (const Input& u : {first, second, third}) delay.Record(u);
  State expected = Driven(Moving(), first, 0.02);
  expected = Driven(expected, second, kPeriod);
  expected = Driven(expected, third, kPeriod);
  EXPECT_LT((delay.Predict(Moving(), 0.0) - expected).norm(), 1e-4);
}

TEST(DelayCompensator, TheAgeOfTheStateIsMadeUpForToo) {
  DelayCompensator delay({}, kPeriod, 0.02);
  const Input before(0.03, 1.0), last(-0.01, -1.0);
  delay.Record(before);
  delay.Record(last);
  // Measured 40 ms ago; the last command began to act 20 ms after it was given, that is 30 ms ago.
  const State expected = Driven(Driven(Moving(), before, 0.01), last, 0.05);
  EXPECT_LT((delay.Predict(Moving(), 0.04) - expected).norm(), 1e-4);
}

TEST(DelayCompensator, DisturbanceActsMeanwhile) {
  DelayCompensator delay({}, kPeriod, 0.1);
  const State z = delay.Predict(Moving(), 0.0, {.delta_0 = 0.02, .a_x = -1.0});
  DelayCompensator steered({}, kPeriod, 0.1);
  steered.Reset({0.02, -1.0});
  EXPECT_EQ(z, steered.Predict(Moving(), 0.0));
  EXPECT_NE(z, delay.Predict(Moving(), 0.0));
}

TEST(DelayCompensator, AfterAResetTheGivenInputsHaveAlwaysActed) {
  DelayCompensator delay({}, kPeriod, 0.2);
  delay.Record({0.4, -5.0});
  delay.Reset({0.01, 0.0});
  EXPECT_LT((delay.Predict(Moving(), 0.1) - Driven(Moving(), {0.01, 0.0}, 0.3)).norm(), 1e-4);
}

TEST(DelayCompensator, AtStandstillNothingMoves) {
  DelayCompensator delay({}, kPeriod, 0.2);
  State still = State::Zero();
  still[kX] = 5.0;
  EXPECT_EQ(delay.Predict(still, 0.1), still);
}

}  // namespace
}  // namespace control
