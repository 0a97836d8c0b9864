#include "control/mpc/trust_region.hpp"

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

class TrustRegionTest : public ::testing::Test {
 protected:
  static constexpr int kHorizon = 6;
  static constexpr std::size_t kLastState = 4, kLastInput = 3;  // those that are measured

  TrustRegionTest() {
    testing::Random random(31);
    plan_.z.assign(kHorizon + 1, random.Filled<State>(1.0));
    plan_.u.assign(kHorizon, random.Filled<Input>(1.0));
    prediction_.Set(plan_);
  }
  double Measure(bool bounded = true) {
    return region_.Measure(prediction_, kLastState, kLastInput, bounded, plan_);
  }
  // The present radii as a multiple of the original ones.
  [[nodiscard]] double Scale() const { return region_.Radius(0) / radii_[0]; }

  Eigen::Vector4d radii_{1.0, 0.5, 0.1, 0.2};  // of υ, ν, ψ, δ
  TrustRegion region_{radii_};
  Prediction prediction_{kHorizon};
  Plan plan_;
};

TEST_F(TrustRegionTest, SchedulingErrorIsTheLargestOfThreeStatesInRadii) {
  const State z_hat = plan_.z[0];
  const auto error = [&](const State& change) { return region_.SchedulingError(z_hat + change, z_hat); };
  EXPECT_EQ(error(State::Zero()), 0.0);
  EXPECT_NEAR(error({0.0, 0.0, -0.3, 0.0, 0.0, 0.0}), 0.3, 1e-12);
  EXPECT_NEAR(error({0.0, 0.0, 0.0, 0.3, 0.0, 0.0}), 0.6, 1e-12);
  EXPECT_NEAR(error({0.0, 0.0, 0.0, 0.0, -0.3, 0.0}), 3.0, 1e-12);
  EXPECT_NEAR(error({0.0, 0.0, 0.9, -0.4, 0.07, 0.0}), 0.9, 1e-12);
  EXPECT_EQ(error({8.0, 8.0, 0.0, 0.0, 0.0, 8.0}), 0.0) << "X, Y and ω schedule nothing";
}

TEST_F(TrustRegionTest, AdaptsToTheErrorBetweenHalfAndTwiceItsRadii) {
  double before = Scale();
  for (int i = 0; i < 20; ++i) {
    region_.Adapt(0.0);
    EXPECT_GE(Scale(), before);
    before = Scale();
  }
  EXPECT_NEAR(Scale(), 2.0, 1e-12);
  for (int i = 0; i < 20; ++i) {
    region_.Adapt(5.0);
    EXPECT_LE(Scale(), before);
    before = Scale();
  }
  EXPECT_NEAR(Scale(), 0.5, 1e-12);
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_NEAR(region_.Radius(j), 0.5 * radii_[static_cast<Eigen::Index>(j)], 1e-12) << j;
  }
  region_.Reset();
  EXPECT_EQ(Scale(), 1.0);
}

TEST_F(TrustRegionTest, JudgesAnErrorByItsPresentRadii) {
  const auto after = [&](double start, double error) {  // sign of the change of the radii
    region_.Reset();
    for (int i = 0; i < 20 && start != 1.0; ++i) region_.Adapt(start > 1.0 ? 0.0 : 5.0);
    const double before = Scale();
    region_.Adapt(error);
    return Scale() > before ? 1 : (Scale() < before ? -1 : 0);
  };
  EXPECT_EQ(after(1.0, 0.2), 1);
  EXPECT_EQ(after(1.0, 0.4), 0);
  EXPECT_EQ(after(1.0, 0.8), -1);
  EXPECT_EQ(after(2.0, 0.8), 0) << "in twice the radii, the error is 0.4";
  EXPECT_EQ(after(2.0, 1.2), -1);
  EXPECT_EQ(after(0.5, 0.2), 0) << "in half the radii, the error is 0.4";
  EXPECT_EQ(after(0.5, 0.1), 1);
}

TEST_F(TrustRegionTest, DeviationIsMeasuredInTheFourVariablesOfTheStepsAsked) {
  const Plan same = plan_;
  const auto expect_deviation = [&](double& changed, double radius, bool counts, const char* what) {
    changed -= 0.7 * radius;
    EXPECT_NEAR(Measure(), counts ? 0.7 : 0.0, 1e-9) << what;
    plan_ = same;
  };
  for (std::size_t i = 0; i <= kHorizon; ++i) {
    const bool counts = i >= 1 && i <= kLastState;
    expect_deviation(plan_.z[i][kUpsilon], radii_[0], counts, "upsilon");
    expect_deviation(plan_.z[i][kNu], radii_[1], counts, "nu");
    expect_deviation(plan_.z[i][kPsi], radii_[2], counts, "psi");
    for (const int other : {kX, kY, kOmega}) expect_deviation(plan_.z[i][other], 1.0, false, "other state");
  }
  for (std::size_t i = 0; i < kHorizon; ++i) {
    expect_deviation(plan_.u[i][kDelta], radii_[3], i <= kLastInput, "delta");
    expect_deviation(plan_.u[i][kAcceleration], 1.0, false, "acceleration");
  }
}

TEST_F(TrustRegionTest, RowsAtOrBeyondTheirBoundAreCountedWithTheirSlack) {
  plan_.z[1][kUpsilon] += 1.0 * radii_[0];
  plan_.z[2][kNu] -= 1.3 * radii_[1];
  plan_.z[4][kPsi] += 0.99 * radii_[2];
  plan_.u[0][kDelta] -= 1.1 * radii_[3];
  EXPECT_NEAR(Measure(), 1.3, 1e-9);
  EXPECT_EQ(plan_.active_trust_rows, 3);
  EXPECT_NEAR(plan_.largest_slack, 0.3, 1e-9);
  EXPECT_NEAR(Measure(false), 1.3, 1e-9);
  EXPECT_EQ(plan_.active_trust_rows, 0) << "there are no such rows";
  EXPECT_EQ(plan_.largest_slack, 0.0);
}

TEST_F(TrustRegionTest, SlackRefersToThePresentRadiiAndTheDeviationToTheOriginalOnes) {
  plan_.z[3][kNu] += 1.5 * radii_[1];
  for (int i = 0; i < 20; ++i) region_.Adapt(0.0);  // twice the radii
  EXPECT_NEAR(Measure(), 1.5, 1e-9);
  EXPECT_EQ(plan_.active_trust_rows, 0);
  EXPECT_EQ(plan_.largest_slack, 0.0);
  for (int i = 0; i < 20; ++i) region_.Adapt(5.0);  // half the radii
  EXPECT_NEAR(Measure(), 1.5, 1e-9);
  EXPECT_EQ(plan_.active_trust_rows, 1);
  EXPECT_NEAR(plan_.largest_slack, 2.0, 1e-9);
}

}  // namespace
}  // namespace control
