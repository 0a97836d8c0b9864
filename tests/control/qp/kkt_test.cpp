#include "control/qp/kkt.hpp"

#include <cmath>
#include <limits>

#include "control/qp/problem.hpp"
#include "gtest/gtest.h"
#include "tests/control/qp/random_qp.hpp"

namespace control {
namespace {

using Qp = OcpQp<1, 1>;
using Point = OcpQpPoint<1, 1>;
using Vector1 = Eigen::Matrix<double, 1, 1>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// min ½ x₁² + ½ u² + ½ 2 ε²,  x₀ = 1, x₁ = x₀ + u,  u ≥ −½ (hard),  x₁ ≤ 0.2 + ε (soft).
Qp SmallQp() {
  Qp qp(1);
  qp.x0[0] = 1.0;
  qp.stages[0].A(0, 0) = 1.0;
  qp.stages[0].B(0, 0) = 1.0;
  qp.stages[0].R[0] = 1.0;
  qp.stages[1].Q[0] = 1.0;
  EXPECT_TRUE(qp.stages[0].AddInputBound(0, -0.5, kNoBound));
  EXPECT_TRUE(qp.stages[1].AddStateBound(0, -kNoBound, 0.2, 2.0));
  return qp;
}

// By hand: u = −½, x₁ = ½, ε = 0.3, λ_hi = ρ ε = 0.6, π₁ = x₁ + λ_hi = 1.1, λ_lo = u + π₁ = 0.6.
Point SmallOptimum() {
  Point point(1);
  point.stages[0].x[0] = 1.0;
  point.stages[0].u[0] = -0.5;
  point.stages[0].lambda[0].lo = 0.6;
  point.stages[1].x[0] = 0.5;
  point.stages[1].pi[0] = 1.1;
  point.stages[1].lambda[0].hi = 0.6;
  point.stages[1].slack[0] = 0.3;
  return point;
}

TEST(EvaluateKkt, IsZeroAtTheOptimum) {
  EXPECT_LT(EvaluateKkt(SmallQp(), SmallOptimum()).Max(), 1e-15);
  EXPECT_NEAR(EvaluateCost(SmallQp(), SmallOptimum()), 0.5 * 0.25 + 0.5 * 0.25 + 0.09, 1e-15);
}

TEST(EvaluateKkt, EachDefectRaisesItsOwnMember) {
  const Qp qp = SmallQp();
  Point point = SmallOptimum();
  point.stages[1].pi[0] += 0.01;  // both gradients
  EXPECT_NEAR(EvaluateKkt(qp, point).stationarity, 0.01, 1e-12);
  EXPECT_LT(EvaluateKkt(qp, point).dynamics, 1e-15);

  point = SmallOptimum();
  point.stages[1].slack[0] += 0.01;  // ρ ε ≠ λ
  EXPECT_NEAR(EvaluateKkt(qp, point).stationarity, 0.02, 1e-12);

  point = SmallOptimum();
  point.stages[0].x[0] += 0.01;
  EXPECT_NEAR(EvaluateKkt(qp, point).dynamics, 0.01, 1e-12);

  point = SmallOptimum();
  point.stages[1].x[0] += 0.01;
  EXPECT_NEAR(EvaluateKkt(qp, point).dynamics, 0.01, 1e-12);
  EXPECT_NEAR(EvaluateKkt(qp, point).rows, 0.01, 1e-12);  // soft: beyond what the slack gives

  point = SmallOptimum();
  point.stages[0].u[0] -= 0.02;
  EXPECT_NEAR(EvaluateKkt(qp, point).rows, 0.02, 1e-12);

  point = SmallOptimum();
  point.stages[0].lambda[0].lo = -0.05;
  EXPECT_NEAR(EvaluateKkt(qp, point).multipliers, 0.05, 1e-12);

  point = SmallOptimum();
  point.stages[0].lambda[0].hi = 0.05;  // of a bound that does not exist
  EXPECT_NEAR(EvaluateKkt(qp, point).multipliers, 0.05, 1e-12);

  point = SmallOptimum();
  point.stages[0].u[0] += 0.1;  // off the bound, multiplier kept
  EXPECT_NEAR(EvaluateKkt(qp, point).complementarity, 0.06, 1e-12);
}

// The same with σ = 0.1 and ρ = 0: u = −½, ε = 0.3, λ_hi = σ, and λ_ε = ρ ε + σ − λ_hi = 0.
TEST(EvaluateKkt, ExactPenaltyImpliesTheMultiplierOfTheSlack) {
  Qp qp = SmallQp();
  qp.stages[1].rows[0].rho = 0.0;
  qp.stages[1].rows[0].sigma = 0.1;
  Point optimum = SmallOptimum();
  optimum.stages[1].lambda[0].hi = 0.1;
  optimum.stages[1].pi[0] = 0.6;
  optimum.stages[0].lambda[0].lo = 0.1;
  EXPECT_LT(EvaluateKkt(qp, optimum).Max(), 1e-15);
  EXPECT_NEAR(EvaluateCost(qp, optimum), 0.5 * 0.25 + 0.5 * 0.25 + 0.03, 1e-15);

  Point point = optimum;
  point.stages[1].lambda[0].hi = 0.15;  // λ_ε = −0.05
  EXPECT_NEAR(EvaluateKkt(qp, point).multipliers, 0.05, 1e-12);

  point = optimum;
  point.stages[1].lambda[0].hi = 0.05;  // λ_ε = 0.05, ε = 0.3
  EXPECT_NEAR(EvaluateKkt(qp, point).complementarity, 0.015, 1e-12);

  qp.stages[1].rows[0].hi = 1.0;  // distance 0.5, so that a negative slack breaks ε ≥ 0 alone
  point = optimum;
  point.stages[1].slack[0] = -0.2;
  EXPECT_NEAR(EvaluateKkt(qp, point).rows, 0.2, 1e-12);
}

TEST(EvaluateKkt, SlackOfAHardRowCountsForNothing) {
  Point point = SmallOptimum();
  point.stages[0].u[0] -= 0.02;
  point.stages[0].slack[0] = 1.0;
  EXPECT_NEAR(EvaluateKkt(SmallQp(), point).rows, 0.02, 1e-12);
}

TEST(EvaluateKkt, ValueThatIsNotANumberIsInfinitelyWrong) {
  using Qp8 = OcpQp<8, 2>;
  testing::Random random(1);
  const Qp8 qp = testing::RandomQp<8, 2>(random, {});
  for (int entry = 0; entry < 8; ++entry) {
    for (int member = 0; member < 3; ++member) {
      OcpQpPoint<8, 2> point(qp.horizon());
      auto& stage = point.stages[1];
      (member == 0 ? stage.x[entry] : member == 1 ? stage.pi[entry] : stage.u[entry % 2]) = kNan;
      EXPECT_EQ(EvaluateKkt(qp, point).Max(), kNoBound) << member << " " << entry;
    }
  }
  for (double RowMultiplier::*side : {&RowMultiplier::lo, &RowMultiplier::hi}) {
    Point point = SmallOptimum();
    point.stages[0].lambda[0].*side = kNan;
    EXPECT_EQ(EvaluateKkt(SmallQp(), point).Max(), kNoBound);
  }
}

TEST(OcpQpStage, RecognisesABoundOfOneVariable) {
  OcpQpStage<2, 2> stage;
  using V = Eigen::Vector2d;
  ASSERT_TRUE(stage.AddRow(V(0.0, 1.0), V::Zero(), 0.0, 1.0));
  ASSERT_TRUE(stage.AddRow(V::Zero(), V(1.0, 0.0), 0.0, 1.0));
  ASSERT_TRUE(stage.AddRow(V(0.0, 2.0), V::Zero(), 0.0, 1.0));
  ASSERT_TRUE(stage.AddRow(V(1.0, 0.0), V(0.0, 1.0), 0.0, 1.0));
  ASSERT_TRUE(stage.AddRow(V::Zero(), V::Zero(), 0.0, 1.0));
  const int general = OcpQpRow<2, 2>::kGeneral;
  const std::array expected{1, 2, general, general, general};
  for (std::size_t j = 0; j < expected.size(); ++j) EXPECT_EQ(stage.rows[j].unit, expected[j]) << j;
}

TEST(OcpQpStage, FullStageRefusesARowAndKeepsTheOthers) {
  OcpQpStage<1, 1> stage;
  for (int j = 0; j < kMaxRows; ++j) ASSERT_TRUE(stage.AddStateBound(0, -j, j));
  EXPECT_FALSE(stage.AddStateBound(0, -1.0, 1.0));
  EXPECT_FALSE(stage.AddInputBound(0, -1.0, 1.0));
  EXPECT_FALSE(stage.AddRow(Vector1(1.0), Vector1(1.0), -1.0, 1.0));
  EXPECT_EQ(stage.row_count, kMaxRows);
  EXPECT_EQ(stage.rows.back().hi, kMaxRows - 1);
}

// x₁ = 1 + u with |u| ≤ 1 cannot exceed 2.
TEST(ProvesInfeasible, NeedsMultipliersThatExcludeEveryInput) {
  Qp qp = SmallQp();
  qp.stages[0].ClearRows();
  qp.stages[1].ClearRows();
  ASSERT_TRUE(qp.stages[0].AddInputBound(0, -1.0, 1.0));
  ASSERT_TRUE(qp.stages[1].AddStateBound(0, 2.5, kNoBound));
  Point point(1);
  EXPECT_FALSE(ProvesInfeasible(qp, point));
  point.stages[0].lambda[0].hi = 1.0;
  EXPECT_FALSE(ProvesInfeasible(qp, point));
  point.stages[1].lambda[0].lo = 1.0;
  EXPECT_TRUE(ProvesInfeasible(qp, point));
  point.stages[0].lambda[0].hi = 0.0;  // the inputs' own bounds are taken into account anyway
  EXPECT_TRUE(ProvesInfeasible(qp, point));
  qp.stages[1].rows[0].lo = 1.9;
  EXPECT_FALSE(ProvesInfeasible(qp, point));
  qp.stages[1].rows[0].lo = 2.5;
  qp.stages[1].rows[0].rho = 1e6;  // soft rows exclude nothing
  EXPECT_FALSE(ProvesInfeasible(qp, point));
  qp.stages[1].rows[0].rho = -1.0;
  qp.stages[0].ClearRows();  // and an input without bound reaches everything
  EXPECT_FALSE(ProvesInfeasible(qp, point));
}

// The first is solved by u = (−9, 10), the second by u = 1e10.
TEST(ProvesInfeasible, InputWithoutBoundMayBeAsLargeAsItHasTo) {
  OcpQp<1, 2> parallel(1);
  const Eigen::Matrix<double, 1, 1> none(0.0);
  ASSERT_TRUE(parallel.stages[0].AddRow(none, Eigen::Vector2d(1.0, 1.0), 1.0, 1.0));
  ASSERT_TRUE(parallel.stages[0].AddRow(none, Eigen::Vector2d(1.0, 1.0 + 1e-9), 1.0 + 1e-8, 1.0 + 1e-8));
  OcpQpPoint<1, 2> difference(1);
  difference.stages[0].lambda[0].hi = difference.stages[0].lambda[1].lo = 1.0;
  EXPECT_FALSE(ProvesInfeasible(parallel, difference));
  OcpQp<1, 1> weak(1);
  weak.stages[0].B(0, 0) = 1e-10;
  ASSERT_TRUE(weak.stages[1].AddStateBound(0, 1.0, kNoBound));
  OcpQpPoint<1, 1> row(1);
  row.stages[1].lambda[0].lo = 1.0;
  EXPECT_FALSE(ProvesInfeasible(weak, row));
  ASSERT_TRUE(weak.stages[0].AddInputBound(0, -1e9, 1e9));
  EXPECT_TRUE(ProvesInfeasible(weak, row));
}

TEST(ProvesInfeasible, NeverOfAFeasibleProblem) {
  testing::Random random(2);
  for (int i = 0; i < 200; ++i) {
    auto qp = testing::RandomQp<8, 2>(random, {.growth = random.Chance(0.5) ? 3.0 : 1.0});
    if (random.Chance(0.5)) {
      // Inputs without bounds.
      for (auto& stage : qp.stages) testing::EraseRows(stage, [](const auto& row) { return row.unit >= 8; });
    }
    OcpQpPoint<8, 2> point(qp.horizon());
    for (int trial = 0; trial < 20; ++trial) {
      for (auto& stage : point.stages) {
        for (auto& lambda : stage.lambda) {
          lambda = {.lo = random.Chance(0.3) ? std::pow(10.0, random.Uniform(-6.0, 9.0)) : 0.0,
                    .hi = random.Chance(0.3) ? std::pow(10.0, random.Uniform(-6.0, 9.0)) : 0.0};
        }
      }
      ASSERT_FALSE(ProvesInfeasible(qp, point)) << i;
    }
  }
}

}  // namespace
}  // namespace control
