#include "control/estimation/disturbance_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gtest/gtest.h"
#include "sim/actuator.hpp"
#include "sim/plant.hpp"
#include "sim/sensors.hpp"
#include "tests/support/allocations.hpp"

namespace control {
namespace {

constexpr double kPeriod = 0.05;
constexpr double kDegree = std::numbers::pi / 180.0;

sim::SensorParameters Noise(double factor) {
  return {.position = 0.02 * factor,
          .speed = 0.02 * factor,
          .heading = 0.0015 * factor,
          .yaw_rate = 0.002 * factor};
}

// The simulated vehicle, kept on the X axis by a plain driver who knows no disturbance, and watched by the estimator.
class Drive {
 public:
  explicit Drive(const sim::PlantParameters& plant, double speed = 25.0, double noise = 0.0)
      : speed_(speed), plant_(plant, Start(speed)), sensors_(Noise(noise), 3) {}

  void Seconds(double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kPeriod)); ++i) Cycle();
  }
  void Cycle() {
    const State z = sensors_.Measure(plant_.state());
    estimator.Update(z + error, Input(steering_.value(), u_[kAcceleration]), kPeriod);
    const double weave = weave_ * std::sin(2.0 * std::numbers::pi * 0.4 * time_);
    u_[kDelta] = weave - 0.01 * z[kY] - 0.15 * z[kPsi];
    u_[kAcceleration] = held_ ? -2.0 : -0.5 * (z[kUpsilon] - speed_);
    steering_.Command(u_[kDelta]);
    for (int i = 0; i < 50; ++i) {
      steering_.Advance(1e-3);
      const Input acting(steering_.value(), u_[kAcceleration]);
      plant_.Step(acting, acting, acting, 1e-3);
    }
    time_ += kPeriod;
  }
  void Weave(double delta) { weave_ = delta; }
  void Hold() { held_ = true; }
  [[nodiscard]] const Disturbance& found() const { return estimator.disturbance(); }
  [[nodiscard]] const State& state() const { return plant_.state(); }

  DisturbanceEstimator estimator{VehicleParameters{}};
  State error = State::Zero();  // of the next measurements

 private:
  static State Start(double speed) {
    State z = State::Zero();
    z[kUpsilon] = speed;
    return z;
  }

  double speed_;
  sim::Plant plant_;
  sim::Sensors sensors_;
  sim::Actuator steering_{{.time_constant = 0.04}, 0.0};
  Input u_ = Input::Zero();
  double time_ = 0.0;
  double weave_ = 0.0;
  bool held_ = false;
};

TEST(DisturbanceEstimator, UndisturbedVehicleHasNoDisturbance) {
  Drive drive({});
  drive.Weave(0.01);
  drive.Seconds(10.0);
  EXPECT_NEAR(drive.found().delta_0, 0.0, 0.02 * kDegree);
  EXPECT_NEAR(drive.found().a_y, 0.0, 0.03);
  EXPECT_NEAR(drive.found().a_x, 0.0, 0.03);
  EXPECT_NEAR(drive.found().stiffness_factor, 1.0, 0.05);
}

TEST(DisturbanceEstimator, SteeringOffsetIsFoundAndNotTakenForBank) {
  for (const double noise : {0.0, 1.0, 3.0}) {
    Drive drive({.steering_offset = kDegree}, 25.0, noise);
    drive.Seconds(5.0);
    EXPECT_NEAR(drive.found().delta_0, kDegree, 0.1 * kDegree) << noise;
    EXPECT_NEAR(drive.found().a_y, 0.0, 0.2) << noise;
  }
}

TEST(DisturbanceEstimator, BankIsFoundAndNotTakenForASteeringOffset) {
  for (const double noise : {0.0, 1.0}) {
    const double bank = std::atan(0.06);
    Drive drive({.bank = bank}, 25.0, noise);
    drive.Seconds(5.0);
    EXPECT_NEAR(drive.found().a_y, kGravity * std::sin(bank), 0.1 * kGravity * std::sin(bank)) << noise;
    EXPECT_NEAR(drive.found().delta_0, 0.0, 0.1 * kDegree) << noise;
  }
}

TEST(DisturbanceEstimator, SlopeIsFoundAtAnySpeed) {
  const double slope = std::atan(0.05);
  for (const double speed : {2.0, 8.0, 25.0}) {
    Drive drive({.slope = slope}, speed, 1.0);
    drive.Seconds(5.0);
    EXPECT_NEAR(drive.found().a_x, -kGravity * std::sin(slope), 0.1 * kGravity * std::sin(slope)) << speed;
  }
}

TEST(DisturbanceEstimator, GustIsFollowedAndForgotten) {
  Drive drive({.wind = {.from = 5.0, .until = 10.0, .lateral_acceleration = 1.5}});
  drive.Seconds(5.0);
  EXPECT_NEAR(drive.found().a_y, 0.0, 0.05);
  drive.Seconds(4.9);
  EXPECT_NEAR(drive.found().a_y, 1.5, 0.5);
  drive.Seconds(5.1);
  EXPECT_NEAR(drive.found().a_y, 0.0, 0.4);
}

TEST(DisturbanceEstimator, StiffnessIsFoundInBendsAndFrozenOnAStraightRoad) {
  sim::PlantParameters soft;
  soft.vehicle.C_alpha_f *= 0.7;
  soft.vehicle.C_alpha_r *= 0.7;
  Drive drive(soft, 20.0, 1.0);
  drive.Seconds(3.0);
  EXPECT_EQ(drive.found().stiffness_factor, 1.0);
  drive.Weave(0.04);
  drive.Seconds(15.0);
  EXPECT_NEAR(drive.found().stiffness_factor, 0.7, 0.07);
}

// What three times the usual noise may do to the estimates, as stated in the header.
TEST(DisturbanceEstimator, NoiseMakesTheEstimatesJitterLittle) {
  for (const double noise : {1.0, 3.0}) {
    Drive drive({}, 25.0, noise);
    drive.Seconds(10.0);
    Eigen::Array3d squared = Eigen::Array3d::Zero(), largest = Eigen::Array3d::Zero();
    const int cycles = 1200;
    for (int i = 0; i < cycles; ++i) {
      drive.Cycle();
      const Disturbance& d = drive.found();
      const Eigen::Array3d error(d.delta_0 / kDegree, d.a_y, d.a_x);
      squared += error.square() / cycles;
      largest = largest.max(error.abs());
    }
    const Eigen::Array3d deviation = squared.sqrt();
    const Eigen::Array3d allowed =
        noise == 1.0 ? Eigen::Array3d(0.01, 0.04, 0.03) : Eigen::Array3d(0.02, 0.1, 0.08);
    EXPECT_TRUE((deviation < allowed).all()) << deviation.transpose() << ", largest " << largest.transpose();
    EXPECT_LT(largest[0], 0.1) << noise;
  }
}

TEST(DisturbanceEstimator, BelowThreeMetresASecondOnlyTheSlopeIsJudged) {
  Drive drive({.steering_offset = kDegree, .bank = 0.05, .slope = -0.05}, 2.5);
  drive.Seconds(5.0);
  EXPECT_EQ(drive.found().delta_0, 0.0);
  EXPECT_EQ(drive.found().a_y, 0.0);
  EXPECT_EQ(drive.found().stiffness_factor, 1.0);
  EXPECT_GT(drive.found().a_x, 0.3);
}

TEST(DisturbanceEstimator, BrakeThatHoldsTheVehicleIsNoSlope) {
  Drive drive({}, 3.0);
  drive.Seconds(2.0);
  drive.Hold();
  drive.Seconds(20.0);
  EXPECT_LT(drive.state()[kUpsilon], 0.01);
  EXPECT_NEAR(drive.found().a_x, 0.0, 0.1);
}

TEST(DisturbanceEstimator, OutlierChangesNothingAndALastingJumpBeginsANewPath) {
  Drive drive({.steering_offset = kDegree}, 25.0, 1.0);
  drive.Seconds(5.0);
  const Disturbance before = drive.found();
  drive.error[kOmega] = 0.5;
  drive.Cycle();
  EXPECT_EQ(drive.estimator.rejected(), 1);
  EXPECT_EQ(drive.found().delta_0, before.delta_0);
  EXPECT_EQ(drive.found().a_y, before.a_y);
  drive.error.setZero();
  drive.Cycle();
  EXPECT_EQ(drive.estimator.rejected(), 0);
  drive.error[kX] = drive.error[kY] = 30.0;
  drive.Seconds(1.0);
  EXPECT_EQ(drive.estimator.rejected(), 0);
  EXPECT_NEAR(drive.estimator.z()[kY] - drive.state()[kY], 30.0, 0.2);
  EXPECT_NEAR(drive.found().delta_0, kDegree, 0.1 * kDegree);
}

TEST(DisturbanceEstimator, EstimateStaysInItsBounds) {
  const EstimatorSettings settings;
  Drive turned({.steering_offset = 4.0 * kDegree}, 10.0);
  turned.Seconds(8.0);
  EXPECT_EQ(turned.found().delta_0, settings.greatest[kSteeringOffset]);
  Drive uphill({.slope = 0.33}, 15.0);
  uphill.Seconds(8.0);
  EXPECT_EQ(uphill.found().a_x, settings.least[kLongitudinal]);
}

TEST(DisturbanceEstimator, GapAndValuesThatAreNotFiniteLeaveTheEstimate) {
  Drive drive({.steering_offset = kDegree});
  drive.Seconds(5.0);
  const double found = drive.found().delta_0;
  State z = drive.state();
  z[kY] += 3.0;
  drive.estimator.Update(z, Input::Zero(), 1.0);
  EXPECT_EQ(drive.found().delta_0, found);
  EXPECT_EQ(drive.estimator.z(), z);
  z[kOmega] = std::numeric_limits<double>::quiet_NaN();
  drive.estimator.Update(z, Input::Zero(), kPeriod);
  EXPECT_EQ(drive.found().delta_0, found);
  drive.estimator.Reset();
  EXPECT_EQ(drive.found().delta_0, 0.0);
}

TEST(DisturbanceEstimator, TakesNoMemory) {
  Drive drive({.steering_offset = kDegree}, 25.0, 1.0);
  const std::size_t before = test_support::Allocations();
  drive.Seconds(2.0);
  EXPECT_EQ(test_support::Allocations(), before);
}

}  // namespace
}  // namespace control
