#include "control/estimation/grip_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "control/estimation/disturbance_estimator.hpp"
#include "gtest/gtest.h"
#include "sim/actuator.hpp"
#include "sim/plant.hpp"
#include "sim/sensors.hpp"

namespace control {
namespace {

constexpr double kPeriod = 0.05;
constexpr double kMu = 0.7;  // assumed

using Driver = std::function<Input(double time)>;

// The least bound during a drive from `speed`, and the last one.
struct Felt {
  double least = kMu;
  double last = kMu;
};

Felt Drive(double mu, double noise, double speed, double seconds, const Driver& driver) {
  sim::PlantParameters parameters;
  parameters.tyre = sim::Tyre::kSaturating;
  parameters.mu = mu;
  State start = State::Zero();
  start[kUpsilon] = speed;
  sim::Plant plant(parameters, start);
  sim::Sensors sensors(
      {.position = 0.02 * noise, .speed = 0.02 * noise, .heading = 0.0015 * noise, .yaw_rate = 0.002 * noise},
      5);
  DisturbanceEstimator estimator(VehicleParameters{}, {.mu = kMu});
  sim::Actuator steering({.time_constant = 0.04}, 0.0);
  Input u = Input::Zero();
  Felt felt;
  for (int i = 0; i * kPeriod < seconds; ++i) {
    estimator.Update(sensors.Measure(plant.state()), {steering.value(), u[kAcceleration]}, kPeriod);
    felt.last = estimator.mu_limit();
    felt.least = std::min(felt.least, felt.last);
    u = driver(i * kPeriod);
    steering.Command(u[kDelta]);
    for (int k = 0; k < 50; ++k) {
      steering.Advance(1e-3);
      const Input acting(steering.value(), u[kAcceleration]);
      plant.Step(acting, acting, acting, 1e-3);
    }
  }
  return felt;
}

Driver Weave(double delta) {
  return [delta](double time) { return Input(delta * std::sin(2.0 * std::numbers::pi * 0.4 * time), 0.0); };
}

Driver Brake(double a, double ramp = 20.0) {
  return [=](double time) { return Input(0.0, std::max(a, -ramp * time)); };
}

TEST(GripEstimator, BendOnASlipperyRoadIsFelt) {
  for (const double noise : {0.0, 1.0, 3.0}) {
    const Felt felt = Drive(0.35, noise, 18.0, 3.0, Weave(0.08));
    EXPECT_LT(felt.least, 0.42) << noise;
    EXPECT_GT(felt.least, 0.25) << noise;
  }
}

TEST(GripEstimator, BrakingOnASlipperyRoadIsFeltWithinHalfASecond) {
  for (const double noise : {0.0, 1.0, 3.0}) {
    const Felt felt = Drive(0.35, noise, 25.0, 0.75, Brake(-6.0));
    EXPECT_LT(felt.last, 0.42) << noise;
    EXPECT_GT(felt.least, 0.25) << noise;
  }
}

TEST(GripEstimator, RoadAsAssumedIsNotFeltToBeWorse) {
  for (const double noise : {0.0, 1.0, 3.0}) {
    for (const double mu : {kMu, 0.9}) {
      EXPECT_GT(Drive(mu, noise, 18.0, 10.0, Weave(0.05)).least, 0.9 * kMu) << noise;
      EXPECT_GT(Drive(mu, noise, 18.0, 10.0, Weave(0.1)).least, 0.7 * kMu) << noise;  // slides
      EXPECT_EQ(Drive(mu, noise, 25.0, 5.0, Brake(-6.0)).least, kMu) << noise;
    }
  }
}

TEST(GripEstimator, BoundRisesSlowlyToTheAssumedCoefficientAndNoFurther) {
  const VehicleParameters vehicle;
  GripEstimator grip(vehicle, kMu);
  const auto brake = [&](double demand, double given, int times) {
    State before = State::Zero();
    before[kUpsilon] = 20.0;
    State after = before;
    after[kUpsilon] -= given * kPeriod;
    for (int i = 0; i < times; ++i) grip.Update(before, after, {0.0, -demand}, {}, kPeriod);
  };
  brake(6.0, 3.0, 20);
  EXPECT_NEAR(grip.limit(), 3.0 / kGravity, 0.02);
  const double felt = grip.limit();
  brake(0.0, 0.0, 20);
  EXPECT_GT(grip.limit(), felt);
  EXPECT_LT(grip.limit(), felt + 0.05);
  brake(0.0, 0.0, 2000);
  EXPECT_EQ(grip.limit(), kMu);
  brake(6.0, 3.0, 20);
  grip.Reset();
  EXPECT_EQ(grip.limit(), kMu);
}

}  // namespace
}  // namespace control
