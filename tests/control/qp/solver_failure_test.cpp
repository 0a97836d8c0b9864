#include <algorithm>
#include <cmath>
#include <string>

#include "tests/control/qp/random_qp.hpp"
#include "tests/control/qp/solver_fixture.hpp"

namespace control {
namespace {

// Lets a solve ask so many times.
TimeLeft Asks(int count) {
  return [count]() mutable { return count-- > 0; };
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

TEST_P(OcpQpSolverBy, WarmStartOfAnyNumbersDoesNoHarm) {
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
