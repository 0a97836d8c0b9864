#include "control/vehicle/discrete_model.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "tests/control/vehicle/rk4.hpp"

namespace control {
namespace {

constexpr double kTs = 0.05;

class DiscreteModelTest : public ::testing::Test {
 protected:
  State RandomState(double upsilon) {
    State z;
    z << 100.0 * Uniform(), 100.0 * Uniform(), upsilon, Uniform(), 3.0 * Uniform(), 0.5 * Uniform();
    return z;
  }
  Input RandomInput() { return {0.3 * Uniform(), 3.0 * Uniform()}; }
  double Uniform() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }

  std::mt19937_64 random_{11};
  BlendedModel model_{VehicleParameters{}};
  DiscreteModel discrete_{model_, kTs};
};

// Compares the derivatives of f(z, u) with its central differences.
template <typename Function>
void ExpectDerivatives(const LinearModel& exact, const State& z, const Input& u, double tolerance,
                       Function f) {
  constexpr double kStep = 1e-5;
  LinearModel near;
  for (int j = 0; j < kStates; ++j) {
    const State e = kStep * State::Unit(j);
    near.A.col(j) = (f(State(z + e), u) - f(State(z - e), u)) / (2.0 * kStep);
  }
  for (int j = 0; j < kInputs; ++j) {
    const Input e = kStep * Input::Unit(j);
    near.B.col(j) = (f(z, Input(u + e)) - f(z, Input(u - e))) / (2.0 * kStep);
  }
  EXPECT_LT((exact.A - near.A).cwiseAbs().maxCoeff(), tolerance) << z[kUpsilon];
  EXPECT_LT((exact.B - near.B).cwiseAbs().maxCoeff(), tolerance) << z[kUpsilon];
}

TEST_F(DiscreteModelTest, DerivativesOfTheModelAndOfItsStepAreThoseOfTheirDifferencesAtAnySpeed) {
  for (double upsilon = 0.0; upsilon < 35.0; upsilon += 0.37) {
    const State z = RandomState(upsilon);
    const Input u = RandomInput();
    ExpectDerivatives(model_.Jacobian(z, u), z, u, 1e-5,
                      [this](const State& x, const Input& v) { return model_.Derivative(x, v); });
    const AffineModel expansion = discrete_.Expand(z, u);
    ExpectDerivatives(expansion.linear, z, u, 1e-7,
                      [this](const State& x, const Input& v) { return discrete_.Step(x, v); });
    const State value = expansion.linear.A * z + expansion.linear.B * u + expansion.c;
    EXPECT_LT((value - discrete_.Step(z, u)).cwiseAbs().maxCoeff(), 1e-12) << upsilon;
  }
}

TEST_F(DiscreteModelTest, DerivativesAreThoseOfTheDifferencesUnderADisturbanceToo) {
  const Disturbance disturbance{.delta_0 = 0.02, .a_y = 0.8, .a_x = -0.5, .stiffness_factor = 0.7};
  const BlendedModel disturbed(VehicleParameters{}, disturbance);
  const DiscreteModel step(disturbed, kTs);
  for (double upsilon = 0.0; upsilon < 35.0; upsilon += 0.37) {
    const State z = RandomState(upsilon);
    const Input u = RandomInput();
    ExpectDerivatives(disturbed.Jacobian(z, u), z, u, 1e-5,
                      [&](const State& x, const Input& v) { return disturbed.Derivative(x, v); });
    const AffineModel expansion = step.Expand(z, u);
    ExpectDerivatives(expansion.linear, z, u, 1e-7,
                      [&](const State& x, const Input& v) { return step.Step(x, v); });
    const State value = expansion.linear.A * z + expansion.linear.B * u + expansion.c;
    EXPECT_LT((value - step.Step(z, u)).cwiseAbs().maxCoeff(), 1e-12) << upsilon;
  }
}

TEST_F(DiscreteModelTest, DisturbanceIsAnotherInputOtherTyresAndALateralAcceleration) {
  const Disturbance disturbance{.delta_0 = 0.02, .a_y = 0.8, .a_x = -0.5, .stiffness_factor = 0.7};
  const BlendedModel disturbed(VehicleParameters{}, disturbance);
  VehicleParameters soft;
  soft.C_alpha_f *= 0.7;
  soft.C_alpha_r *= 0.7;
  for (double upsilon = BlendedModel::kUpsilon2; upsilon < 40.0; upsilon += 1.3) {
    const State z = RandomState(upsilon);
    const Input u = RandomInput();
    State expected = SingleTrackModel(soft).Derivative(z, u + Input(0.02, -0.5));
    expected[kNu] += 0.8;
    EXPECT_LT((disturbed.Derivative(z, u) - expected).cwiseAbs().maxCoeff(), 1e-12) << upsilon;
  }
}

TEST_F(DiscreteModelTest, FastTheModelIsTheDynamicOne) {
  const SingleTrackModel dynamic{VehicleParameters{}};
  for (double upsilon = BlendedModel::kUpsilon2; upsilon < 40.0; upsilon += 1.3) {
    const State z = RandomState(upsilon);
    const Input u = RandomInput();
    EXPECT_LT((model_.Derivative(z, u) - dynamic.Derivative(z, u)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST_F(DiscreteModelTest, SlowItRollsOnACircleWithoutSlip) {
  const VehicleParameters v;
  const Input u(0.2, 0.0);
  State z = State::Zero();
  z[kUpsilon] = 2.0;
  for (int i = 0; i < 40; ++i) z = discrete_.Step(z, u);  // ν and ω settle
  // The middle of the rear axle moves along the vehicle at υ, on a radius of (l_f + l_r)/tan δ.
  EXPECT_NEAR(z[kOmega] * (v.l_f + v.l_r) / std::tan(u[kDelta]), z[kUpsilon], 0.02);
  EXPECT_NEAR(z[kNu], v.l_r * z[kOmega], 0.01);
}

TEST_F(DiscreteModelTest, StandingItStandsWhateverTheWheelsDo) {
  State z = State::Zero();
  z[kX] = 3.0;
  z[kPsi] = 1.0;
  for (const double delta : {0.0, 0.5, -0.5}) {
    EXPECT_EQ(discrete_.Step(z, {delta, 0.0}), z);
    const AffineModel expansion = discrete_.Expand(z, {delta, 0.0});
    EXPECT_TRUE(expansion.linear.A.allFinite());
    EXPECT_TRUE(expansion.linear.B.allFinite());
  }
}

TEST_F(DiscreteModelTest, DisturbanceOfTheLateralMotionDiesOutAtAnySpeed) {
  for (double upsilon = 0.0; upsilon < 40.0; upsilon += 0.1) {
    State z = State::Zero();
    z[kUpsilon] = upsilon;
    const LinearModel d = discrete_.Expand(z, Input::Zero()).linear;
    Eigen::Matrix2d lateral;
    lateral << d.A(kNu, kNu), d.A(kNu, kOmega), d.A(kOmega, kNu), d.A(kOmega, kOmega);
    EXPECT_LT(lateral.eigenvalues().cwiseAbs().maxCoeff(), 1.0) << upsilon;
  }
}

TEST_F(DiscreteModelTest, ErrorOfAStepFallsWithTheFifthPowerOfItsLength) {
  for (const double upsilon : {1.0, 6.0, 12.0, 25.0}) {
    const State z = RandomState(upsilon);
    const Input u = RandomInput();
    const auto error = [&](double t_s) {
      const State flow = testing::Rk4(z, t_s, 200, [&](const State& x) { return model_.Derivative(x, u); });
      return (DiscreteModel(model_, t_s).Step(z, u) - flow).norm();
    };
    EXPECT_NEAR(std::log2(error(0.01) / error(0.005)), 5.0, 0.5) << upsilon;
  }
}

}  // namespace
}  // namespace control
