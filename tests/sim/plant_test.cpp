#include "sim/plant.hpp"

#include <algorithm>
#include <cmath>

#include "control/vehicle/blended_model.hpp"
#include "control/vehicle/single_track.hpp"
#include "gtest/gtest.h"

namespace sim {
namespace {

using control::Input;
using control::State;

State Rolling(double upsilon, double nu = 0.0, double omega = 0.0) {
  State z = State::Zero();
  z[control::kUpsilon] = upsilon;
  z[control::kNu] = nu;
  z[control::kOmega] = omega;
  return z;
}

State Drive(const PlantParameters& parameters, const State& initial, const Input& u, double duration,
            double h = 1e-3) {
  Plant plant(parameters, initial);
  const int steps = static_cast<int>(std::lround(duration / h));
  for (int i = 0; i < steps; ++i) plant.Step(u, u, u, h);
  return plant.state();
}

PlantParameters Flat() {
  PlantParameters parameters;
  parameters.track_front = parameters.track_rear = parameters.height = 0.0;
  return parameters;
}

PlantParameters Saturating(double mu) {
  PlantParameters parameters;
  parameters.tyre = Tyre::kSaturating;
  parameters.mu = mu;
  return parameters;
}

double KineticEnergy(const PlantParameters& parameters, const State& z) {
  return 0.5 * parameters.vehicle.m *
             (z[control::kUpsilon] * z[control::kUpsilon] + z[control::kNu] * z[control::kNu]) +
         0.5 * parameters.vehicle.I_z * z[control::kOmega] * z[control::kOmega];
}

TEST(Plant, StraightLineStaysStraight) {
  for (const PlantParameters& parameters : {PlantParameters{}, Saturating(0.7)}) {
    const State z = Drive(parameters, Rolling(10.0), Input(0.0, 1.0), 3.0);
    EXPECT_NEAR(z[control::kX], 34.5, 1e-9);
    EXPECT_NEAR(z[control::kUpsilon], 13.0, 1e-9);
    for (const int i : {control::kY, control::kNu, control::kPsi, control::kOmega})
      EXPECT_NEAR(z[i], 0.0, 1e-12);
  }
}

// The terms that the bicycle model omits are of second order in ν, ω, δ and a.
TEST(Plant, FlatWithLinearTyresIsTheBicycleForSmallAngles) {
  const PlantParameters parameters = Flat();
  const Plant plant(parameters, State::Zero());
  const control::SingleTrackModel bicycle(parameters.vehicle);
  const auto difference = [&](double scale) {
    State z = Rolling(12.0, 0.4 * scale, 0.3 * scale);
    z[control::kPsi] = 0.7;
    const Input u(0.05 * scale, 1.5 * scale);
    return (plant.Derivative(z, u) - bicycle.Derivative(z, u)).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(difference(1e-3), 1e-5);
  EXPECT_NEAR(std::log2(difference(2e-3) / difference(1e-3)), 2.0, 0.1);
}

// Bank, slope, wind and steering offset are the disturbances of the controllers' model.
TEST(Plant, DisturbedItIsTheDisturbedModelForSmallAngles) {
  PlantParameters parameters = Flat();
  parameters.steering_offset = 2e-4;
  parameters.bank = 0.03;
  parameters.slope = 0.02;
  parameters.wind = {.from = 0.0, .until = 1.0, .lateral_acceleration = 0.5};
  const control::BlendedModel model(
      parameters.vehicle,
      {.delta_0 = 2e-4, .a_y = kGravity * std::sin(0.03) + 0.5, .a_x = -kGravity * std::sin(0.02)});
  const Plant plant(parameters, State::Zero());
  const State z = Rolling(12.0, 4e-4, 3e-4);
  const Input u(5e-5, 1.5e-3);
  EXPECT_LT((plant.Derivative(z, u) - model.Derivative(z, u)).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Plant, BrakeThatIsStrongerThanTheSlopeHoldsTheVehicleStill) {
  for (PlantParameters parameters : {PlantParameters{}, Saturating(0.5)}) {
    for (const double slope : {0.1, -0.1}) {
      parameters.slope = slope;
      const double pull = -kGravity * std::sin(slope);
      EXPECT_EQ(Drive(parameters, Rolling(0.0), Input(0.0, -1.05), 5.0), Rolling(0.0)) << slope;
      const State rolled = Drive(parameters, Rolling(0.0), Input(0.0, -0.5), 2.0);
      EXPECT_NEAR(rolled[control::kUpsilon], 2.0 * (pull - std::copysign(0.5, pull)), 0.15) << slope;
      const State stopped = Drive(parameters, rolled, Input(0.0, -3.0), 3.0);
      EXPECT_EQ(stopped.tail<4>(), State(0.0, 0.0, 0.0, 0.0, 0.0, 0.0).tail<4>()) << slope;
    }
  }
  PlantParameters ice = Saturating(0.05);
  ice.slope = 0.1;
  EXPECT_LT(Drive(ice, Rolling(0.0), Input(0.0, -3.0), 2.0)[control::kUpsilon], -0.5);
}

TEST(Plant, WindBlowsInItsTimeAlone) {
  PlantParameters parameters;
  parameters.wind = {.from = 1.0, .until = 2.0, .lateral_acceleration = 1.0};
  EXPECT_EQ(Drive(parameters, Rolling(20.0), Input::Zero(), 1.0)[control::kNu], 0.0);
  EXPECT_GT(Drive(parameters, Rolling(20.0), Input::Zero(), 1.5)[control::kNu], 0.01);
  EXPECT_NEAR(Drive(parameters, Rolling(20.0), Input::Zero(), 6.0)[control::kNu], 0.0, 1e-3);
}

TEST(Plant, SteadyCorneringFollowsTheUndersteerFormula) {
  const control::VehicleParameters v;
  const double speed = 14.0;
  const double delta = 2e-3;
  const double wheelbase = v.l_f + v.l_r;
  const double understeer = v.m / wheelbase * (v.l_r / (2.0 * v.C_alpha_f) - v.l_f / (2.0 * v.C_alpha_r));
  const double expected = speed * delta / (wheelbase + understeer * speed * speed);
  for (const PlantParameters& parameters : {PlantParameters{}, Flat(), Saturating(1.0)}) {
    const State z = Drive(parameters, Rolling(speed), Input(delta, 0.0), 4.0);
    EXPECT_NEAR(z[control::kOmega], expected, 0.01 * expected);
  }
}

TEST(Plant, LeftSteeringTurnsLeft) {
  const State z = Drive(PlantParameters{}, Rolling(10.0), Input(0.05, 0.0), 2.0);
  EXPECT_GT(z[control::kPsi], 0.1);
  EXPECT_GT(z[control::kY], 1.0);
}

TEST(Plant, CoastingNeverGainsEnergy) {
  for (const PlantParameters& parameters : {PlantParameters{}, Saturating(0.8)}) {
    Plant plant(parameters, Rolling(18.0, 3.0, 0.8));
    double energy = KineticEnergy(parameters, plant.state());
    for (int i = 0; i < 20000; ++i) {
      const double delta = 0.3 * std::sin(0.002 * i);
      plant.Step(Input(delta, 0.0), Input(delta, 0.0), Input(delta, 0.0), 1e-3);
      const double now = KineticEnergy(parameters, plant.state());
      ASSERT_LE(now, energy * (1.0 + 1e-12)) << i;
      energy = now;
    }
  }
}

TEST(Plant, IntegratorConvergesWithOrderFour) {
  const State initial = Rolling(15.0);
  const Input u(0.03, 0.5);
  const auto error = [&](double h) {
    return (Drive(PlantParameters{}, initial, u, 1.0, h) -
            Drive(PlantParameters{}, initial, u, 1.0, 1.0 / 1024))
        .norm();
  };
  EXPECT_NEAR(std::log2(error(1.0 / 64) / error(1.0 / 128)), 4.0, 0.3);
}

TEST(Plant, StepOfAMillisecondIsAccurateDownToWalkingSpeed) {
  const State initial = Rolling(1.0, 0.05, 0.1);
  const Input u(0.2, 0.0);
  const State coarse = Drive(PlantParameters{}, initial, u, 1.0, 1e-3);
  EXPECT_LT((coarse - Drive(PlantParameters{}, initial, u, 1.0, 1e-4)).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Plant, TyreForceNeverExceedsFriction) {
  const double mu = 0.7;
  const Plant plant(Saturating(mu), State::Zero());
  for (double nu = -6.0; nu <= 6.0; nu += 1.5) {
    for (double omega = -1.5; omega <= 1.5; omega += 0.5) {
      for (double a = -9.0; a <= 9.0; a += 3.0) {
        for (double delta = -0.6; delta <= 0.6; delta += 0.3) {
          for (const WheelForces& wheel : plant.Forces(Rolling(12.0, nu, omega), Input(delta, a))) {
            EXPECT_LE(std::hypot(wheel.F_x, wheel.F_y), mu * wheel.F_z * (1.0 + 1e-12) + 1e-9);
          }
        }
      }
    }
  }
}

TEST(Plant, SaturatingTyreIsLinearForSmallSlip) {
  const PlantParameters parameters = Saturating(0.9);
  const Plant plant(parameters, State::Zero());
  const auto wheels = plant.Forces(Rolling(12.0), Input(1e-5, 0.0));
  EXPECT_NEAR(wheels[kFrontLeft].F_y, parameters.vehicle.C_alpha_f * 1e-5, 1e-3);
}

TEST(Plant, LoadsAddUpToTheWeightAndAreNeverNegative) {
  const PlantParameters parameters;
  const Plant plant(parameters, State::Zero());
  for (double omega = -2.0; omega <= 2.0; omega += 0.5) {
    for (double a = -12.0; a <= 6.0; a += 3.0) {
      double sum = 0.0;
      for (const WheelForces& wheel : plant.Forces(Rolling(20.0, 0.0, omega), Input(0.0, a))) {
        EXPECT_GE(wheel.F_z, 0.0);
        sum += wheel.F_z;
      }
      EXPECT_NEAR(sum, parameters.vehicle.m * kGravity, 1e-6);
    }
  }
}

TEST(Plant, DrivenAxleAloneDrivesAndBothBrake) {
  for (const auto driven : {control::DrivenAxle::kFront, control::DrivenAxle::kRear}) {
    PlantParameters parameters = Saturating(0.3);
    parameters.vehicle.driven = driven;
    const Plant plant(parameters, State::Zero());
    const bool front = driven == control::DrivenAxle::kFront;
    const auto gentle = plant.Forces(Rolling(10.0), Input(0.0, 0.5));
    EXPECT_EQ(gentle[front ? kRearLeft : kFrontLeft].F_x, 0.0);
    EXPECT_NEAR(2.0 * gentle[front ? kFrontLeft : kRearLeft].F_x, parameters.vehicle.m * 0.5, 1e-6);
    // More than that axle's tyres hold.
    const auto wheels = plant.Forces(Rolling(10.0), Input(0.0, 2.0));
    const WheelForces& slides = wheels[front ? kFrontLeft : kRearLeft];
    EXPECT_NEAR(slides.F_x, 0.3 * slides.F_z, 1e-6);
    for (const WheelForces& wheel : plant.Forces(Rolling(10.0), Input(0.0, -1.0))) EXPECT_LT(wheel.F_x, 0.0);
  }
}

TEST(Plant, LoadMovesOutwardsInATurnAndForwardsUnderBraking) {
  const Plant plant(PlantParameters{}, State::Zero());
  const auto turning = plant.Forces(Rolling(15.0, 0.0, 0.3), Input(0.0, 0.0));
  EXPECT_GT(turning[kFrontRight].F_z, turning[kFrontLeft].F_z);
  EXPECT_GT(turning[kRearRight].F_z, turning[kRearLeft].F_z);
  const auto rolling = plant.Forces(Rolling(15.0), Input(0.0, 0.0));
  const auto braking = plant.Forces(Rolling(15.0), Input(0.0, -4.0));
  EXPECT_GT(braking[kFrontLeft].F_z, rolling[kFrontLeft].F_z);
}

TEST(Plant, BrakedVehicleComesToRestAndStays) {
  for (const PlantParameters& parameters : {PlantParameters{}, Saturating(0.8)}) {
    Plant plant(parameters, Rolling(5.0, 0.1, 0.1));
    const Input u(0.2, -3.0);
    for (int i = 0; i < 4000; ++i) {
      plant.Step(u, u, u, 1e-3);
      ASSERT_GE(plant.state()[control::kUpsilon], -1e-3) << i;
    }
    const State stopped = plant.state();
    EXPECT_TRUE(stopped.allFinite());
    EXPECT_NEAR(stopped[control::kUpsilon], 0.0, 1e-6);
    for (int i = 0; i < 4000; ++i) plant.Step(u, u, u, 1e-3);
    EXPECT_LT((plant.state() - stopped).norm(), 1e-6);
  }
}

TEST(Plant, StandingVehicleStands) {
  const State z = Drive(PlantParameters{}, State::Zero(), Input(0.3, 0.0), 2.0);
  EXPECT_EQ(z.norm(), 0.0);
}

TEST(Plant, VehicleStartsFromStandstill) {
  const State z = Drive(PlantParameters{}, State::Zero(), Input(0.1, 1.0), 3.0);
  EXPECT_TRUE(z.allFinite());
  EXPECT_GT(z[control::kUpsilon], 2.5);
  EXPECT_GT(z[control::kPsi], 0.0);
}

}  // namespace
}  // namespace sim
