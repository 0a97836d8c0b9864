#include "sim/sensors.hpp"

#include <cmath>

#include "gtest/gtest.h"

namespace sim {
namespace {

using control::State;

TEST(Sensors, WithoutNoiseTellTheTruth) {
  State truth;
  truth << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  Sensors sensors({}, 1);
  EXPECT_EQ(sensors.Measure(truth), truth);
}

TEST(Sensors, SameSeedGivesTheSameNoise) {
  const SensorParameters parameters{.position = 0.1, .speed = 0.1, .heading = 0.1, .yaw_rate = 0.1};
  Sensors a(parameters, 5);
  Sensors b(parameters, 5);
  Sensors other(parameters, 6);
  const State first = a.Measure(State::Zero());
  EXPECT_EQ(first, b.Measure(State::Zero()));
  EXPECT_NE(first, other.Measure(State::Zero()));
  EXPECT_NE(first, a.Measure(State::Zero()));
}

TEST(Sensors, NoiseHasTheGivenDeviationAndNoMean) {
  const SensorParameters parameters{.position = 0.5, .speed = 0.2, .heading = 0.01, .yaw_rate = 0.03};
  Sensors sensors(parameters, 3);
  const int count = 20000;
  State sum = State::Zero();
  State squares = State::Zero();
  for (int i = 0; i < count; ++i) {
    const State noise = sensors.Measure(State::Zero());
    sum += noise;
    squares += noise.cwiseAbs2();
  }
  State sigma;
  sigma << 0.5, 0.5, 0.2, 0.2, 0.01, 0.03;
  for (int i = 0; i < control::kStates; ++i) {
    EXPECT_NEAR(std::sqrt(squares[i] / count), sigma[i], 0.03 * sigma[i]);
    EXPECT_NEAR(sum[i] / count, 0.0, 0.03 * sigma[i]);
  }
}

}  // namespace
}  // namespace sim
