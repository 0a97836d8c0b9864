#include "control/qp/solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "tests/control/qp/random_qp.hpp"
#include "tests/control/qp/solver_fixture.hpp"

namespace control {
namespace {

INSTANTIATE_TEST_SUITE_P(, OcpQpSolverBy, ::testing::Values(0, 3, 96), [](const auto& by) {
  return by.param == 0 ? "InteriorPoint" : (by.param == 3 ? "Either" : "ActiveSet");
});

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

TEST_P(OcpQpSolverBy, WarmStartLeadsToTheSameOptimum) {
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
  for (const auto& [other_name, name] : {std::pair{"s0trN8_0041.qp", "s0trN8_0044.qp"},
                                         {"s7trN15_0041.qp", "s7trN15_0044.qp"},
                                         {"s7trN15_0044.qp", "s7trN15_0047.qp"},
                                         {"s7trN15_0011.qp", "s7trN15_0044.qp"}}) {
    const Qp qp = ReadInstance(name), other_qp = ReadInstance(other_name);
    Solver solver(qp.horizon(), settings_), other_solver(qp.horizon());
    ASSERT_EQ(other_solver.Solve(other_qp).status, SolverStatus::kSolved);
    ASSERT_EQ(solver.Solve(qp).status, SolverStatus::kSolved);
    const Eigen::Vector2d cold = solver.solution().stages[0].u;
    EXPECT_EQ(solver.Solve(qp, &other_solver.solution()).status, SolverStatus::kSolved);
    EXPECT_LT(EvaluateKkt(qp, solver.solution()).Max(), 1e-6) << name;
    EXPECT_LT((solver.solution().stages[0].u - cold).cwiseAbs().maxCoeff(), 1e-6) << name;
  }
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

}  // namespace
}  // namespace control
