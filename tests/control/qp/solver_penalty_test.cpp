#include <algorithm>
#include <cmath>
#include <string>

#include "tests/control/qp/random_qp.hpp"
#include "tests/control/qp/solver_fixture.hpp"

namespace control {
namespace {

TEST_P(OcpQpSolverBy, SoftRowWithContradictoryBoundsTakesTheSlackBetweenThem) {
  for (const double rho : {0.0, 0.5, 10.0, 1e4}) {
    for (const double sigma : {0.0, 0.3, 2.0, 1e3}) {
      if (rho == 0.0 && sigma == 0.0) continue;
      OcpQp<1, 1> qp = Scalar(0.0);
      ASSERT_TRUE(qp.stages[1].AddStateBound(0, 1.0, -1.0, rho, sigma));  // 1 − ε ≤ x ≤ −1 + ε: ε ≥ 1 + |x|
      OcpQpSolver<1, 1> solver(1, settings_);
      ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << rho << " " << sigma;
      // min ½(x−1)² + ½x² + ½ρ(1+|x|)² + σ(1+|x|): 2x − 1 + ρ(1 + x) + σ = 0 if that x is positive, 0 otherwise.
      const double x = std::max(0.0, (1.0 - rho - sigma) / (2.0 + rho));
      EXPECT_NEAR(solver.solution().stages[1].x[0], x, 1e-6) << rho << " " << sigma;
      EXPECT_NEAR(solver.solution().stages[1].slack[0], 1.0 + x, 1e-6) << rho << " " << sigma;
      EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-7) << rho << " " << sigma;
    }
  }
}

TEST_P(OcpQpSolverBy, SoftRowGivesWayByItsWeight) {
  for (const double rho : {0.0, 0.1, 1.0, 1e3, 1e6}) {
    OcpQp<1, 1> qp = Scalar(0.0);
    ASSERT_TRUE(qp.stages[1].AddStateBound(0, -kNoBound, 0.2, rho));
    OcpQpSolver<1, 1> solver(1, settings_);
    ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << rho;
    EXPECT_NEAR(solver.solution().stages[1].x[0], (1.0 + 0.2 * rho) / (2.0 + rho), 1e-7) << rho;
  }
}

// The multiplier of x ≤ hi is 1 − 2x: 0.6 where x = 0.2 is held. Where σ is too small for that, the row is relaxed:
// min ½(x−1)² + ½x² + ½ρ(x−hi)² + σ(x−hi).
TEST_P(OcpQpSolverBy, ExactPenaltyHoldsARowWhoseMultiplierIsBelowIt) {
  for (const double rho : {0.0, 1e-3, 1.0, 1e3}) {
    for (const double sigma : {1e-3, 0.1, 0.5, 0.59, 0.61, 1.0, 10.0, 1e4}) {
      OcpQp<1, 1> qp = Scalar(0.0);
      ASSERT_TRUE(qp.stages[1].AddStateBound(0, -kNoBound, 0.2, rho, sigma));
      OcpQpSolver<1, 1> solver(1, settings_);
      ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << rho << " " << sigma;
      const double x = std::max(0.2, (1.0 + 0.2 * rho - sigma) / (2.0 + rho));
      EXPECT_NEAR(solver.solution().stages[1].x[0], x, 1e-7) << rho << " " << sigma;
      EXPECT_NEAR(solver.solution().stages[1].slack[0], x - 0.2, 1e-6) << rho << " " << sigma;
      EXPECT_NEAR(solver.solution().stages[1].lambda[0].hi, 1.0 - 2.0 * x, 1e-6) << rho << " " << sigma;
      EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-7) << rho << " " << sigma;
    }
  }
}

// Among these are problems in which the predictor and corrector alone go round in a cycle of three steps.
TEST_P(OcpQpSolverBy, ExactPenaltyOfAnySizeIsSolvedFromFarAndNear) {
  OcpQpSolver<1, 1> solver(1, settings_);
  for (const double rho : {0.0, 1e-3, 1.0, 1e3}) {
    for (const double hi : {0.49, -3.0, -100.0}) {
      for (double sigma = 1e-3; sigma < 1e5; sigma *= 1.3) {
        OcpQp<1, 1> qp = Scalar(0.0);
        ASSERT_TRUE(qp.stages[1].AddStateBound(0, -kNoBound, hi, rho, sigma));
        const QpResult result = solver.Solve(qp);
        ASSERT_EQ(result.status, SolverStatus::kSolved) << rho << " " << hi << " " << sigma;
        EXPECT_LE(result.iterations, 30) << rho << " " << hi << " " << sigma;
        const double x = std::max(hi, (1.0 + hi * rho - sigma) / (2.0 + rho));
        EXPECT_NEAR(solver.solution().stages[1].x[0], x, 1e-5) << rho << " " << hi << " " << sigma;
      }
    }
  }
}

TEST_P(OcpQpSolverBy, RowsThatCanHoldAreHeldByAnExactPenaltyAsIfTheyWereHard) {
  testing::Random random(8);
  int active = 0;
  for (int i = 0; i < 100; ++i) {
    Qp qp = testing::RandomQp<8, 2>(random, {});
    // The hard rows alone: they are feasible by construction.
    for (auto& stage : qp.stages) testing::EraseRows(stage, [](const auto& row) { return row.soft(); });
    Solver hard(qp.horizon(), settings_), exact(qp.horizon(), settings_);
    ASSERT_EQ(hard.Solve(qp).status, SolverStatus::kSolved) << i;
    Qp soft = qp;
    for (std::size_t k = 0; k < qp.stages.size(); ++k) {
      for (std::size_t j = 0; j < static_cast<std::size_t>(qp.stages[k].row_count); ++j) {
        const RowMultiplier& lambda = hard.solution().stages[k].lambda[j];
        if (lambda.lo + lambda.hi > 0.1) ++active;
        soft.stages[k].rows[j].rho = 0.0;
        soft.stages[k].rows[j].sigma = 1.2 * (lambda.lo + lambda.hi) + 0.5;
      }
    }
    ASSERT_EQ(exact.Solve(soft).status, SolverStatus::kSolved) << i;
    EXPECT_LT(EvaluateKkt(soft, exact.solution()).Max(), 1e-6) << i;
    for (std::size_t k = 0; k < qp.stages.size(); ++k) {
      const auto& at = exact.solution().stages[k];
      EXPECT_LT((at.u - hard.solution().stages[k].u).cwiseAbs().maxCoeff(), 1e-5) << i;
      for (std::size_t j = 0; j < static_cast<std::size_t>(qp.stages[k].row_count); ++j) {
        EXPECT_NEAR(at.slack[j], 0.0, 1e-7) << i;
      }
    }
  }
  EXPECT_GT(active, 200);
}

// x = u reaches 1 at most: 1.5 ≤ x is violated by a half whatever it costs, −0.7 is not.
TEST_P(OcpQpSolverBy, ExactPenaltyOfARowThatCannotHoldLeavesTheLeastSlack) {
  for (const double rho : {0.0, 1.0}) {
    for (const double sigma : {10.0, 1e3, 1e5}) {
      OcpQp<1, 1> qp = Scalar(0.0);
      ASSERT_TRUE(qp.stages[0].AddInputBound(0, -1.0, 1.0));
      ASSERT_TRUE(qp.stages[1].AddStateBound(0, 1.5, kNoBound, rho, sigma));
      ASSERT_TRUE(qp.stages[1].AddStateBound(0, -0.7, kNoBound, rho, sigma));
      OcpQpSolver<1, 1> solver(1, settings_);
      ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << rho << " " << sigma;
      const auto& at = solver.solution().stages[1];
      EXPECT_NEAR(at.slack[0], 0.5, 1e-7) << rho << " " << sigma;
      EXPECT_NEAR(at.slack[1], 0.0, 1e-7) << rho << " " << sigma;
      EXPECT_NEAR(at.lambda[0].lo, sigma + 0.5 * rho, 1e-6) << rho << " " << sigma;
    }
  }
}

TEST_P(OcpQpSolverBy, OptimumInsideExactRowsTakesNoIteration) {
  OcpQp<1, 1> qp = Scalar(0.0);
  ASSERT_TRUE(qp.stages[1].AddStateBound(0, 0.4, 0.6, 1.0, 5.0));
  OcpQpSolver<1, 1> solver(1, settings_);
  const QpResult result = solver.Solve(qp);
  EXPECT_EQ(result.status, SolverStatus::kSolved);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(solver.solution().stages[1].slack[0], 0.0);
  EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-12);
}

TEST_P(OcpQpSolverBy, WarmStartLeadsToTheSameOptimumOfExactPenaltiesInFewerIterations) {
  testing::Random random(9);
  int cold = 0, warm = 0;
  for (int i = 0; i < 60; ++i) {
    const Qp qp = testing::RandomQp<8, 2>(random, {.exact = 1.0});
    Solver solver(qp.horizon(), settings_);
    const QpResult from_nothing = solver.Solve(qp);
    ASSERT_EQ(from_nothing.status, SolverStatus::kSolved) << i;
    cold += from_nothing.iterations;
    const Point optimum = solver.solution();
    const QpResult from_optimum = solver.Solve(qp, &optimum);
    ASSERT_EQ(from_optimum.status, SolverStatus::kSolved) << i;
    warm += from_optimum.iterations;
    EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-6) << i;
    EXPECT_LT((solver.solution().stages[0].u - optimum.stages[0].u).cwiseAbs().maxCoeff(), 1e-5) << i;
    Point beside = optimum;  // a slack and a multiplier that belong to another problem
    for (auto& stage : beside.stages) {
      stage.slack.fill(0.3);
      stage.lambda.fill({.lo = 1e3, .hi = 1e3});
    }
    ASSERT_EQ(solver.Solve(qp, &beside).status, SolverStatus::kSolved) << i;
    EXPECT_LT((solver.solution().stages[0].u - optimum.stages[0].u).cwiseAbs().maxCoeff(), 1e-5) << i;
  }
  EXPECT_LT(warm, GetParam() == 0 ? cold / 2 : cold);
}

TEST_P(OcpQpSolverBy, RowThatCostsNothingChangesNothingAndHasTheSlackItNeeds) {
  testing::Random random(10);
  for (int i = 0; i < 50; ++i) {
    Qp qp = testing::RandomQp<8, 2>(random, {});
    Solver solver(qp.horizon(), settings_);
    ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << i;
    const Point optimum = solver.solution();
    auto& stage = qp.stages[static_cast<std::size_t>(random.Integer(1, qp.horizon()))];
    ASSERT_TRUE(stage.AddStateBound(0, random.Uniform(-3.0, 3.0), kNoBound, 0.0));
    ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << i;
    EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-6) << i;
    EXPECT_LT((solver.solution().stages[0].u - optimum.stages[0].u).cwiseAbs().maxCoeff(), 1e-5) << i;
  }
}

}  // namespace
}  // namespace control
