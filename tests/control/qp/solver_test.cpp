#include "control/qp/solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>

#include "config/qp_file.hpp"
#include "control/qp/solver.hpp"
#include "gtest/gtest.h"
#include "tests/control/qp/random_qp.hpp"

namespace control {
namespace {

using Qp = OcpQp<8, 2>;
using Point = OcpQpPoint<8, 2>;
using Solver = OcpQpSolver<8, 2>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Recorded {
  double cost;
  Eigen::Vector2d u;
};

std::map<std::string, Recorded> RecordedOptima() {
  std::ifstream file(LPVMPC_TEST_DATA "/qp/optimal.csv");
  std::map<std::string, Recorded> optima;
  std::string line;
  std::getline(file, line);  // header
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::string name, cost, delta, a;
    std::getline(fields, name, ',');
    std::getline(fields, cost, ',');
    std::getline(fields, delta, ',');
    std::getline(fields, a, ',');
    optima[name] = {std::stod(cost), {std::stod(delta), std::stod(a)}};
  }
  return optima;
}

Qp ReadInstance(const std::string& name) {
  return config::QpFile(LPVMPC_TEST_DATA "/qp/" + name).Build();
}

// By the active set where it may know rows, by the interior point where it may not, by either where it may know few.
class OcpQpSolverBy : public ::testing::TestWithParam<int> {
 protected:
  QpSettings settings_{.max_working_set = GetParam()};
};

INSTANTIATE_TEST_SUITE_P(, OcpQpSolverBy, ::testing::Values(0, 3, 96), [](const auto& by) {
  return by.param == 0 ? "InteriorPoint" : (by.param == 3 ? "Either" : "ActiveSet");
});

TEST_P(OcpQpSolverBy, RecordedInstancesReachTheirOptimum) {
  const auto optima = RecordedOptima();
  ASSERT_EQ(optima.size(), 7u);
  for (const auto& [name, optimum] : optima) {
    const Qp qp = ReadInstance(name);
    Solver solver(qp.horizon(), settings_);
    EXPECT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << name;
    EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-6) << name;
    // The recorded optima are themselves exact to about 1e-5 in the cost, whose absolute positions take the
    // digits, and so to 2e-5 in the acceleration where that is loosely determined, as in s7trN15_0041.
    const double tolerance = name == "s7trN15_0041.qp" ? 2e-5 : 1e-5;
    EXPECT_LT((solver.solution().stages[0].u - optimum.u).cwiseAbs().maxCoeff(), tolerance) << name;
    EXPECT_LT(EvaluateCost(qp, solver.solution()), optimum.cost + 1e-12 * std::abs(optimum.cost)) << name;
  }
}

// The optimality conditions as one dense linear system in (x_1..x_N, u_0..u_{N-1}, π_1..π_N).
TEST_P(OcpQpSolverBy, UnconstrainedProblemIsTheDenseLinearSystemsSolution) {
  testing::Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    Qp qp = testing::RandomQp<8, 2>(random, {});
    for (auto& stage : qp.stages) stage.ClearRows();
    const int N = qp.horizon(), n = 18 * N;
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n);
    const auto X = [](int i) { return 8 * (i - 1); };
    const auto U = [&](int i) { return 8 * N + 2 * i; };
    const auto Pi = [&](int i) { return 10 * N + 8 * (i - 1); };
    for (int i = 0; i < N; ++i) {
      const auto& stage = qp.stages[static_cast<std::size_t>(i)];
      const auto& next = qp.stages[static_cast<std::size_t>(i) + 1];
      // ½xᵀQx + qᵀx + πᵀ(A x + B u + c − x'), by x', u and π.
      M.block<8, 8>(X(i + 1), X(i + 1)) = next.Q.asDiagonal();
      M.block<8, 8>(X(i + 1), Pi(i + 1)) = -Eigen::Matrix<double, 8, 8>::Identity();
      M.block<8, 8>(Pi(i + 1), X(i + 1)) = -Eigen::Matrix<double, 8, 8>::Identity();
      rhs.segment<8>(X(i + 1)) = -next.q;
      M.block<2, 2>(U(i), U(i)) = stage.R.asDiagonal();
      M.block<2, 8>(U(i), Pi(i + 1)) = stage.B.transpose();
      M.block<8, 2>(Pi(i + 1), U(i)) = stage.B;
      rhs.segment<2>(U(i)) = -stage.r;
      rhs.segment<8>(Pi(i + 1)) = -stage.c;
      if (i > 0) {
        M.block<8, 8>(X(i), Pi(i + 1)) = stage.A.transpose();
        M.block<8, 8>(Pi(i + 1), X(i)) = stage.A;
      } else {
        rhs.segment<8>(Pi(1)) -= stage.A * qp.x0;
      }
    }
    const Eigen::VectorXd dense = M.partialPivLu().solve(rhs);
    Solver solver(N, settings_);
    const QpResult result = solver.Solve(qp);
    EXPECT_EQ(result.status, SolverStatus::kSolved);
    EXPECT_EQ(result.iterations, 0);
    for (int i = 0; i < N; ++i) {
      const auto& at = solver.solution().stages[static_cast<std::size_t>(i)];
      const auto& next = solver.solution().stages[static_cast<std::size_t>(i) + 1];
      EXPECT_LT((at.u - dense.segment<2>(U(i))).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT((next.x - dense.segment<8>(X(i + 1))).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT((next.pi - dense.segment<8>(Pi(i + 1))).cwiseAbs().maxCoeff(), 1e-10);
    }
  }
}

// One state, one input, one step: x₁ = x₀ + u, cost ½ (x₁ − 1)² + ½ u², whose optimum is x₁ = ½ (1 + x₀).
OcpQp<1, 1> Scalar(double x0) {
  OcpQp<1, 1> qp(1);
  qp.x0[0] = x0;
  qp.stages[0].A(0, 0) = 1.0;
  qp.stages[0].B(0, 0) = 1.0;
  qp.stages[0].R[0] = 1.0;
  qp.stages[1].Q[0] = 1.0;
  qp.stages[1].q[0] = -1.0;
  return qp;
}

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

// Of x ≤ hi the multiplier is 1 − 2x: 0.6 where x = 0.2 is held. What σ does not pay for, x gives way:
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

TEST_P(OcpQpSolverBy, GuessLeadsToTheSameOptimum) {
  for (const char* name : {"s0trN8_0044.qp", "s7trN15_0044.qp", "s7trN15_0047.qp"}) {
    const Qp qp = ReadInstance(name);
    Solver solver(qp.horizon(), settings_);
    const QpResult cold = solver.Solve(qp);
    ASSERT_EQ(cold.status, SolverStatus::kSolved);
    const Point optimum = solver.solution();
    const QpResult warm = solver.Solve(qp, &optimum);
    EXPECT_EQ(warm.status, SolverStatus::kSolved);
    EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-6);
    EXPECT_LT((solver.solution().stages[0].u - optimum.stages[0].u).cwiseAbs().maxCoeff(), 1e-6);
  }
  // The solution of the instance recorded three steps earlier, and one of a quite different problem.
  for (const auto& [guess_name, name] : {std::pair{"s0trN8_0041.qp", "s0trN8_0044.qp"},
                                         {"s7trN15_0041.qp", "s7trN15_0044.qp"},
                                         {"s7trN15_0044.qp", "s7trN15_0047.qp"},
                                         {"s7trN15_0011.qp", "s7trN15_0044.qp"}}) {
    const Qp qp = ReadInstance(name), guess_qp = ReadInstance(guess_name);
    Solver solver(qp.horizon(), settings_), guess_solver(qp.horizon());
    ASSERT_EQ(guess_solver.Solve(guess_qp).status, SolverStatus::kSolved);
    ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved);
    const Eigen::Vector2d cold = solver.solution().stages[0].u;
    EXPECT_EQ(solver.Solve(qp, &guess_solver.solution()).status, SolverStatus::kSolved);
    EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-6) << name;
    EXPECT_LT((solver.solution().stages[0].u - cold).cwiseAbs().maxCoeff(), 1e-6) << name;
  }
}

TEST_P(OcpQpSolverBy, GuessLeadsToTheSameOptimumOfExactPenaltiesInFewerIterations) {
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

TEST_P(OcpQpSolverBy, OneSidedRowHoldsOnItsSideAlone) {
  OcpQpSolver<1, 1> solver(1, settings_);
  OcpQp<1, 1> qp = Scalar(0.0);
  ASSERT_TRUE(qp.stages[1].AddStateBound(0, 0.7, kNoBound));
  ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved);
  EXPECT_NEAR(solver.solution().stages[1].x[0], 0.7, 1e-7);
  qp.stages[1].rows[0].lo = -100.0;
  ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved);
  EXPECT_NEAR(solver.solution().stages[1].x[0], 0.5, 1e-7);
  qp.stages[1].rows[0].lo = -kNoBound;
  qp.stages[1].rows[0].hi = -3.0;
  ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved);
  EXPECT_NEAR(solver.solution().stages[1].x[0], -3.0, 1e-7);
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

TEST_P(OcpQpSolverBy, EqualBoundsAreAnEquation) {
  OcpQpSolver<1, 1> solver(1, settings_);
  for (const double value : {-2.0, 0.3, 0.5, 40.0}) {
    OcpQp<1, 1> qp = Scalar(0.0);
    ASSERT_TRUE(qp.stages[0].AddRow(Eigen::Matrix<double, 1, 1>(0.5), Eigen::Matrix<double, 1, 1>(2.0),
                                    2.0 * value, 2.0 * value));
    ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << value;
    EXPECT_NEAR(solver.solution().stages[0].u[0], value, 1e-7);
    EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-7) << value;
  }
}

TEST_P(OcpQpSolverBy, EquationsThatNearlyDependOnEachOtherAreSolved) {
  using VectorU = Eigen::Vector2d;
  OcpQpSolver<1, 2> solver(1, settings_);
  for (const double gap : {1e-3, 1e-4, 1e-5}) {
    OcpQp<1, 2> qp(1);
    auto& stage = qp.stages[0];
    stage.R.setOnes();
    const Eigen::Matrix<double, 1, 1> zero(0.0);
    ASSERT_TRUE(stage.AddRow(zero, VectorU(1.0, 1.0), 1.0, 1.0));
    ASSERT_TRUE(stage.AddRow(zero, VectorU(1.0, 1.0 + gap), 1.0 + 2.0 * gap, 1.0 + 2.0 * gap));
    const QpResult result = solver.Solve(qp);
    ASSERT_EQ(result.status, SolverStatus::kSolved) << gap;
    EXPECT_EQ(result.method, GetParam() > 0 ? QpMethod::kActiveSet : QpMethod::kInteriorPoint) << gap;
    const KktResidual residual = EvaluateKkt(qp, solver.solution());
    EXPECT_LT(residual.rows, 1e-8) << gap;
    EXPECT_LT(residual.complementarity, gap > 1e-5 ? 1e-8 : 1e-4) << gap;
    EXPECT_LT((solver.solution().stages[0].u - VectorU(-1.0, 2.0)).norm(), 3e-8 / gap) << gap;
  }
}

// The multipliers grow with the cost, and what they need for round-off; the rows do not.
TEST_P(OcpQpSolverBy, HardRowHoldsHoweverLargeTheCost) {
  OcpQpSolver<1, 1> solver(1, settings_);
  for (const double scale : {1.0, 1e3, 1e6, 1e9, 1e12}) {
    OcpQp<1, 1> qp = Scalar(0.0);
    qp.stages[0].R *= scale;
    qp.stages[1].Q *= scale;
    qp.stages[1].q *= scale;
    ASSERT_TRUE(qp.stages[1].AddStateBound(0, -kNoBound, 0.45));
    const QpResult result = solver.Solve(qp);
    if (GetParam() > 0) {
      EXPECT_EQ(result.status, SolverStatus::kSolved) << scale;
    }
    if (result.feasible) {
      EXPECT_LE(solver.solution().stages[1].x[0], 0.45 + 1e-8) << scale;
    }
  }
}

// Enough growth for the usual form of the recursion to lose its digits in some of them.
TEST_P(OcpQpSolverBy, DynamicsThatGrowByMuchKeepTheirDigits) {
  testing::Random random(13);
  for (int i = 0; i < 300; ++i) {
    Qp qp = testing::RandomQp<8, 2>(random, {.growth = 3.0});
    for (auto& stage : qp.stages) stage.ClearRows();
    Solver solver(qp.horizon(), settings_);
    ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << i;
    double largest_pi = 0.0;
    for (const auto& stage : solver.solution().stages)
      largest_pi = std::max(largest_pi, stage.pi.cwiseAbs().maxCoeff());
    EXPECT_LT(EvaluateKkt(qp, solver.solution()).stationarity, 1e-8 + 1e-11 * largest_pi) << i;
  }
}

TEST_P(OcpQpSolverBy, ContradictionIsProven) {
  OcpQpSolver<1, 1> solver(1, settings_);
  const auto expect_proof = [&](const OcpQp<1, 1>& qp, const char* what) {
    EXPECT_EQ(solver.Solve(qp).status, SolverStatus::kInfeasible) << what;
    EXPECT_TRUE(ProvesInfeasible(qp, solver.solution())) << what;
  };
  OcpQp<1, 1> qp = Scalar(0.0);
  ASSERT_TRUE(qp.stages[1].AddStateBound(0, 1.0, -1.0));
  expect_proof(qp, "bounds crossed");
  qp = Scalar(0.0);
  ASSERT_TRUE(qp.stages[1].AddStateBound(0, 1.0, kNoBound));
  ASSERT_TRUE(qp.stages[1].AddStateBound(0, -kNoBound, 0.999));
  ASSERT_TRUE(qp.stages[0].AddInputBound(0, -10.0, 10.0));
  expect_proof(qp, "two rows");
  qp = Scalar(0.0);
  ASSERT_TRUE(qp.stages[0].AddInputBound(0, -1.0, 1.0));
  ASSERT_TRUE(qp.stages[1].AddStateBound(0, 1.01, kNoBound));
  expect_proof(qp, "out of the input's reach");
  qp = Scalar(3.0);
  ASSERT_TRUE(qp.stages[0].AddStateBound(0, -1.0, 1.0));
  expect_proof(qp, "the given state is outside");
  qp = Scalar(0.0);
  ASSERT_TRUE(
      qp.stages[0].AddRow(Eigen::Matrix<double, 1, 1>(0.0), Eigen::Matrix<double, 1, 1>(0.0), 1.0, kNoBound));
  expect_proof(qp, "0 ≥ 1");
  qp = Scalar(0.0);
  ASSERT_TRUE(qp.stages[0].AddInputBound(0, -1.0, 1.0));
  ASSERT_TRUE(qp.stages[1].AddStateBound(0, 1.01, kNoBound));
  ASSERT_TRUE(qp.stages[1].AddStateBound(0, -kNoBound, -5.0, 1.0, 100.0));
  expect_proof(qp, "out of the input's reach, beside an exact penalty");
}

TEST_P(OcpQpSolverBy, ContradictionBetweenUnboundedInputsIsNeverSolved) {
  OcpQpSolver<1, 1> solver(1, settings_);
  for (const double gap : {1e-6, 1e-3, 1.0, 100.0}) {
    OcpQp<1, 1> qp = Scalar(0.0);
    ASSERT_TRUE(qp.stages[1].AddStateBound(0, 1.0, kNoBound));
    ASSERT_TRUE(qp.stages[1].AddStateBound(0, -kNoBound, 1.0 - gap));
    const SolverStatus status = solver.Solve(qp).status;
    EXPECT_TRUE(status == SolverStatus::kInfeasible || status == SolverStatus::kIterationLimit) << gap;
  }
}

TEST(OcpQpSolver, FirstIterationIsNotTheLastIfOnlyOneIsAllowed) {
  const Qp qp = ReadInstance("s7trN15_0041.qp");
  Solver solver(qp.horizon(), {.max_iterations = 1, .max_working_set = 0});
  const QpResult result = solver.Solve(qp);
  EXPECT_EQ(result.status, SolverStatus::kIterationLimit);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_GT(result.kkt_residual, 1e-8);
}

// Lets a solve ask so many times.
TimeLeft Asks(int count) {
  return [count]() mutable { return count-- > 0; };
}

TEST_P(OcpQpSolverBy, SolveThatIsStoppedSettlesForTheBestFeasiblePoint) {
  testing::Random random(11);
  int stopped = 0, own = 0;
  for (int i = 0; i < 100; ++i) {
    const Qp qp = testing::RandomQp<8, 2>(random, {.equalities = 0.0, .exact = 0.5});
    Solver solver(qp.horizon(), settings_);
    ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << i;
    const Point optimum = solver.solution();
    const double least = EvaluateCost(qp, optimum);
    for (int asks = 0; asks < 20; ++asks) {
      const TimeLeft alone = Asks(asks), guided = Asks(asks);
      const QpResult result = solver.Solve(qp, nullptr, &alone);
      if (result.status == SolverStatus::kSolved) break;
      ASSERT_EQ(result.status, SolverStatus::kIterationLimit) << i;
      ++stopped;
      const KktResidual residual = EvaluateKkt(qp, solver.solution());
      EXPECT_LT(residual.dynamics, 1e-8) << i;
      if (result.feasible) {
        ++own;
        EXPECT_LT(residual.rows, 1e-7) << i;
        EXPECT_GT(EvaluateCost(qp, solver.solution()), least - 1e-6 * std::abs(least)) << i;
      }
      // The optimum's inputs are feasible, and nothing is cheaper.
      const QpResult better = solver.Solve(qp, &optimum, &guided);
      EXPECT_TRUE(better.feasible) << i;
      EXPECT_NEAR(EvaluateCost(qp, solver.solution()), least, 1e-6 * (1.0 + std::abs(least))) << i;
      EXPECT_LT(EvaluateKkt(qp, solver.solution()).rows, 1e-7) << i;
    }
  }
  EXPECT_GT(stopped, 100);
  if (GetParam() == 0) {
    EXPECT_GT(own, 0);  // iterates of the active set are on the other side until the end
  }
}

TEST_P(OcpQpSolverBy, SolveThatIsStoppedHasTheSlacksOfItsPointAndGetsBetterWithTime) {
  testing::Random random(12);
  int stopped = 0, cheaper = 0, dearer = 0;
  for (int i = 0; i < 100; ++i) {
    Qp qp = testing::RandomQp<8, 2>(random, {.exact = 0.5});
    for (auto& stage : qp.stages) {
      for (auto& row : stage.rows) row.rho = std::max(row.rho, 0.0) + 1.0;
    }
    Solver solver(qp.horizon(), settings_);
    double first = 0.0;
    for (int asks = 0; asks < 10; ++asks) {
      const TimeLeft time_left = Asks(asks);
      const QpResult result = solver.Solve(qp, nullptr, &time_left);
      ASSERT_TRUE(result.feasible) << i << ": with soft rows alone every point is";
      if (result.status == SolverStatus::kSolved) break;
      ++stopped;
      const KktResidual residual = EvaluateKkt(qp, solver.solution());
      EXPECT_LT(std::max(residual.rows, residual.dynamics), 1e-8) << i;
      const double cost = EvaluateCost(qp, solver.solution());
      if (asks == 0) first = cost;
      cheaper += static_cast<int>(cost < first);
      dearer += static_cast<int>(cost > first);
    }
  }
  EXPECT_GT(stopped, 100);
  EXPECT_GT(cheaper, 5 * dearer) << "the longer, the better";
}

TEST_P(OcpQpSolverBy, SolveThatIsStoppedWithoutAFeasiblePointSaysSo) {
  const Qp qp = ReadInstance("s0trN8_0041.qp");
  Solver solver(qp.horizon(), settings_);
  Point outside(qp.horizon());
  for (auto& stage : outside.stages) stage.u.fill(100.0);
  const TimeLeft none = Asks(0);
  const QpResult result = solver.Solve(qp, &outside, &none);
  EXPECT_EQ(result.status, SolverStatus::kIterationLimit);
  EXPECT_FALSE(result.feasible);
}

TEST_P(OcpQpSolverBy, SolvesAgainAfterAFailure) {
  const Qp qp = ReadInstance("s0trN8_0041.qp");
  Solver solver(qp.horizon(), settings_);
  ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved);
  const Eigen::Vector2d u = solver.solution().stages[0].u;
  const auto expect_the_same = [&](const char* after) {
    ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved) << after;
    EXPECT_EQ(solver.solution().stages[0].u, u) << after;
  };
  Qp broken = qp;
  broken.stages[3].A(2, 2) = kNan;
  EXPECT_EQ(solver.Solve(broken).status, SolverStatus::kNumericalFailure);
  expect_the_same("a number that is none");
  broken = qp;
  broken.stages[3].A.fill(1e200);
  EXPECT_EQ(solver.Solve(broken).status, SolverStatus::kNumericalFailure);
  expect_the_same("dynamics that overflow");
  broken = qp;
  ASSERT_TRUE(broken.stages[3].AddRow(Eigen::Matrix<double, 8, 1>::Constant(1e306), Eigen::Vector2d::Zero(),
                                      0.0, 1.0));
  EXPECT_NE(solver.Solve(broken).status, SolverStatus::kSolved);
  expect_the_same("a row that overflows");
  broken = qp;
  ASSERT_TRUE(broken.stages[3].AddStateBound(2, 1e3, kNoBound));
  EXPECT_EQ(solver.Solve(broken).status, SolverStatus::kInfeasible);
  expect_the_same("a contradiction");
  for (int asks = 0; asks < 5; ++asks) {
    const TimeLeft time_left = Asks(asks);
    EXPECT_EQ(solver.Solve(qp, nullptr, &time_left).status, SolverStatus::kIterationLimit) << asks;
    expect_the_same("a limit of time");
  }
}

TEST_P(OcpQpSolverBy, GuessOfAnyNumbersDoesNoHarm) {
  const Qp qp = ReadInstance("s0trN8_0041.qp");
  Solver solver(qp.horizon(), settings_);
  ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved);
  const Point optimum = solver.solution();
  const TimeLeft none = Asks(0);
  for (const double bad : {kNan, kInfinity, 1e200, -1e200}) {
    for (int part = 0; part < 4; ++part) {
      Point warm_start = optimum;
      auto& stage = warm_start.stages[3];
      if (part == 0) stage.u.fill(bad);
      if (part == 1) stage.pi.fill(bad);
      if (part == 2) stage.lambda.fill({.lo = bad, .hi = bad});
      if (part == 3) stage.slack.fill(bad);
      ASSERT_EQ(solver.Solve(qp, &warm_start).status, SolverStatus::kSolved) << bad << " in part " << part;
      EXPECT_LT((solver.solution().stages[0].u - optimum.stages[0].u).norm(), 1e-5)
          << bad << " in part " << part;
      EXPECT_TRUE(part > 0 || !solver.Solve(qp, &warm_start, &none).feasible) << bad;
    }
  }
}

TEST_P(OcpQpSolverBy, CostWithoutCurvatureInAnInputIsAFailure) {
  OcpQp<1, 1> qp = Scalar(0.0);
  qp.stages[0].R[0] = 0.0;
  qp.stages[0].B(0, 0) = 0.0;
  EXPECT_EQ((OcpQpSolver<1, 1>(1, settings_).Solve(qp).status), SolverStatus::kNumericalFailure);
}

TEST_P(OcpQpSolverBy, RowWhoseValueOverflowsIsAFailure) {
  OcpQp<2, 1> qp(1);
  qp.stages[0].R[0] = 1.0;
  qp.stages[0].c.fill(1e10);
  ASSERT_TRUE(qp.stages[1].AddRow(Eigen::Vector2d(1e300, -1e300), Eigen::Matrix<double, 1, 1>::Zero(), 1e300,
                                  kNoBound));
  EXPECT_EQ((OcpQpSolver<2, 1>(1, settings_).Solve(qp).status), SolverStatus::kNumericalFailure);
}

// Each number of the problem in turn, in a problem with active rows and in one without.
TEST_P(OcpQpSolverBy, AnyNumberThatIsNotFiniteIsAFailure) {
  for (const char* name : {"s0trN8_0044.qp", "s0trN8_0005.qp"}) {
    Qp qp = ReadInstance(name);
    Solver solver(qp.horizon(), settings_);
    const auto expect_failure = [&](double& number, double bad, const char* what, std::size_t stage) {
      const double good = number;
      number = bad;
      EXPECT_EQ(solver.Solve(qp).status, SolverStatus::kNumericalFailure)
          << what << " = " << bad << " in stage " << stage;
      number = good;
    };
    const auto expect_failures = [&](auto& matrix, const char* what, std::size_t stage) {
      for (const double bad : {kNan, kInfinity, -kInfinity}) {
        for (Eigen::Index k = 0; k < matrix.size(); ++k) expect_failure(matrix.data()[k], bad, what, stage);
      }
    };
    expect_failures(qp.x0, "x0", 0);
    for (const std::size_t i : {std::size_t{0}, std::size_t{3}, qp.stages.size() - 1}) {
      auto& stage = qp.stages[i];
      if (i + 1 < qp.stages.size()) {
        expect_failures(stage.A, "A", i);
        expect_failures(stage.B, "B", i);
        expect_failures(stage.c, "c", i);
        expect_failures(stage.R, "R", i);
        expect_failures(stage.r, "r", i);
      }
      expect_failures(stage.Q, "Q", i);
      expect_failures(stage.q, "q", i);
      for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
        expect_failures(stage.rows[j].C, "C", i);
        expect_failures(stage.rows[j].D, "D", i);
        expect_failure(stage.rows[j].lo, kNan, "lo", i);
        expect_failure(stage.rows[j].lo, kInfinity, "lo", i);
        expect_failure(stage.rows[j].hi, kNan, "hi", i);
        expect_failure(stage.rows[j].hi, -kInfinity, "hi", i);
        expect_failure(stage.rows[j].rho, kNan, "rho", i);
        expect_failure(stage.rows[j].rho, kInfinity, "rho", i);
        expect_failure(stage.rows[j].sigma, kNan, "sigma", i);
        expect_failure(stage.rows[j].sigma, kInfinity, "sigma", i);
        expect_failure(stage.rows[j].sigma, -1.0, "sigma", i);
      }
    }
  }
}

}  // namespace
}  // namespace control
