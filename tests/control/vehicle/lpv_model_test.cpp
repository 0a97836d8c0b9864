#include "control/vehicle/lpv_model.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "control/vehicle/single_track.hpp"
#include "gtest/gtest.h"
#include "tests/control/random.hpp"
#include "tests/control/vehicle/rk4.hpp"

namespace control {
namespace {

constexpr double kStep = 0.05;
constexpr double kPi = std::numbers::pi;

Scheduling SchedulingOf(const State& z, const Input& u) {
  return {.upsilon = z[kUpsilon], .nu = z[kNu], .delta = u[kDelta], .psi = z[kPsi]};
}

State RandomState(testing::Random& random, double upsilon) {
  State z;
  z << random.Uniform(-500.0, 500.0), random.Uniform(-500.0, 500.0), upsilon, random.Uniform(-3.0, 3.0),
      random.Uniform(-2.0 * kPi, 2.0 * kPi), random.Uniform(-2.0, 2.0);
  return z;
}

Input RandomInput(testing::Random& random) {
  return {random.Uniform(-0.6, 0.6), random.Uniform(-6.0, 2.0)};
}

// Spectral radius of the lateral dynamics (ν, ω).
double LateralRadius(const LinearModel& model) {
  Eigen::Matrix2d lateral;
  lateral << model.A(kNu, kNu), model.A(kNu, kOmega), model.A(kOmega, kNu), model.A(kOmega, kOmega);
  return lateral.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(SingleTrackModel, StraightDriveMovesAlongTheHeadingOnly) {
  State z = State::Zero();
  z[kUpsilon] = 10.0;
  z[kPsi] = kPi / 6.0;
  const State f = SingleTrackModel({}).Derivative(z, {0.0, 1.5});
  State expected;
  expected << 10.0 * std::cos(kPi / 6.0), 5.0, 1.5, 0.0, 0.0, 0.0;
  EXPECT_LT((f - expected).cwiseAbs().maxCoeff(), 1e-12);
}

// Steady turn of the linear bicycle model: δ = (l + K υ²) ω / υ with K = m (l_r C_r − l_f C_f) / (2 l C_f C_r).
TEST(SingleTrackModel, SteadyTurnNeedsTheUndersteerGradientsSteeringAngle) {
  const VehicleParameters p;
  const double l = p.l_f + p.l_r, upsilon = 15.0, omega = 0.01;
  const double K = p.m * (p.l_r * p.C_alpha_r - p.l_f * p.C_alpha_f) / (2.0 * l * p.C_alpha_f * p.C_alpha_r);
  const double delta = (l + K * upsilon * upsilon) * omega / upsilon;
  State z = State::Zero();
  z[kUpsilon] = upsilon;
  z[kOmega] = omega;
  z[kNu] = omega * (p.l_r - p.m * p.l_f * upsilon * upsilon / (2.0 * l * p.C_alpha_r));
  const State f = SingleTrackModel(p).Derivative(z, {delta, 0.0});
  EXPECT_NEAR(f[kNu], 0.0, 1e-4);  // cos δ ≈ 1
  EXPECT_NEAR(f[kOmega], 0.0, 1e-12);
}

TEST(SingleTrackModel, MirroredStateAndSteeringGiveTheMirroredMotion) {
  testing::Random random(3);
  State mirror;
  mirror << 1.0, -1.0, 1.0, -1.0, -1.0, -1.0;
  const SingleTrackModel model({});
  for (int i = 0; i < 50; ++i) {
    const State z = RandomState(random, random.Uniform(1.0, 40.0));
    const Input u = RandomInput(random);
    const State f = model.Derivative(z, u);
    const State mirrored = model.Derivative(mirror.cwiseProduct(z), {-u[kDelta], u[kAcceleration]});
    EXPECT_LT((mirrored - mirror.cwiseProduct(f)).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(LpvModel, EqualsTheNonlinearModelWhereItIsScheduled) {
  testing::Random random(1);
  VehicleParameters parameters;
  for (int i = 0; i < 500; ++i) {
    parameters.C_alpha_f = random.Uniform(5e4, 2e5);
    parameters.m = random.Uniform(800.0, 3000.0);
    const State z = RandomState(random, random.Uniform(LpvModel::kMinUpsilon, 60.0));
    const Input u = RandomInput(random);
    const LinearModel c = LpvModel(parameters).Continuous(SchedulingOf(z, u));
    const State f = SingleTrackModel(parameters).Derivative(z, u);
    const State embedded = c.A * z + c.B * u;
    const double scale = (c.A.cwiseAbs() * z.cwiseAbs() + c.B.cwiseAbs() * u.cwiseAbs()).maxCoeff();
    EXPECT_LT((embedded - f).cwiseAbs().maxCoeff(), 1e-14 * scale);
  }
}

TEST(LpvModel, StaysFiniteAtStandstill) {
  const LpvModel model({});
  for (const auto method : {Discretisation::kEuler, Discretisation::kZeroOrderHold}) {
    for (const double upsilon : {-1.0, 0.0, 0.1}) {
      const LinearModel d = model.Discrete({.upsilon = upsilon}, kStep, method);
      EXPECT_TRUE(d.A.allFinite() && d.B.allFinite()) << upsilon;
    }
  }
}

TEST(LpvModel, EulerIsTheFirstOrderStep) {
  testing::Random random(2);
  const LpvModel model({});
  for (int i = 0; i < 100; ++i) {
    const Scheduling p = SchedulingOf(RandomState(random, random.Uniform(0.5, 60.0)), RandomInput(random));
    const LinearModel c = model.Continuous(p), d = model.Discrete(p, kStep, Discretisation::kEuler);
    using Matrix = Eigen::Matrix<double, kStates, kStates>;
    EXPECT_LT((d.A - Matrix::Identity() - kStep * c.A).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((d.B - kStep * c.B).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(LpvModel, ZeroOrderHoldIsTheMatrixExponential) {
  testing::Random random(4);
  const LpvModel model({});
  using Matrix = Eigen::Matrix<double, kStates + kInputs, kStates + kInputs>;
  for (int i = 0; i < 300; ++i) {
    const double upsilon = 0.5 * std::pow(120.0, i / 299.0);  // 0.5 to 60 m/s
    const double t_s = random.Uniform(0.01, 0.2);
    const Scheduling p = SchedulingOf(RandomState(random, upsilon), RandomInput(random));
    const LinearModel c = model.Continuous(p), d = model.Discrete(p, t_s, Discretisation::kZeroOrderHold);
    Matrix generator = Matrix::Zero();
    generator.topLeftCorner<kStates, kStates>() = c.A;
    generator.topRightCorner<kStates, kInputs>() = c.B;
    const Matrix reference = (generator * t_s).exp();
    const double scale = reference.cwiseAbs().maxCoeff();
    EXPECT_LT((d.A - reference.topLeftCorner<kStates, kStates>()).cwiseAbs().maxCoeff(), 1e-12 * scale);
    EXPECT_LT((d.B - reference.topRightCorner<kStates, kInputs>()).cwiseAbs().maxCoeff(), 1e-12 * scale);
  }
}

TEST(LpvModel, ZeroOrderHoldIntegratesTheFrozenModel) {
  testing::Random random(5);
  const LpvModel model({});
  for (const double upsilon : {0.5, 2.0, 9.0, 25.0, 60.0}) {
    const State z = RandomState(random, upsilon);
    const Input u = RandomInput(random);
    const LinearModel c = model.Continuous(SchedulingOf(z, u));
    const LinearModel d = model.Discrete(SchedulingOf(z, u), kStep, Discretisation::kZeroOrderHold);
    const State integrated =
        testing::Rk4(z, kStep, 4000, [&](const State& at) { return State(c.A * at + c.B * u); });
    EXPECT_LT((d.A * z + d.B * u - integrated).cwiseAbs().maxCoeff(), 1e-9) << upsilon;
  }
}

TEST(LpvModel, EulerIsUnstableBelowTenMetresPerSecondZeroOrderHoldNever) {
  const LpvModel model({});
  for (double upsilon = 0.5; upsilon <= 60.0; upsilon += 0.1) {
    const Scheduling p{.upsilon = upsilon};
    const double euler = LateralRadius(model.Discrete(p, kStep, Discretisation::kEuler));
    if (std::abs(upsilon - 10.0) > 0.05) {
      EXPECT_EQ(euler > 1.0, upsilon < 10.0) << upsilon;
    }
    EXPECT_LT(LateralRadius(model.Discrete(p, kStep, Discretisation::kZeroOrderHold)), 1.0) << upsilon;
  }
}

}  // namespace
}  // namespace control
