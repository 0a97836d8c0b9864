// The solver against Ipopt on random problems with hard and soft, one- and two-sided rows.
#include <algorithm>
#include <cmath>

#include "control/qp/solver.hpp"
#include "gtest/gtest.h"
#include "tests/control/qp/ipopt_qp.hpp"
#include "tests/control/qp/random_qp.hpp"

namespace control {
namespace {

using testing::Random;
using testing::RandomQp;
using testing::RandomQpOptions;

template <int kNx, int kNu>
double CostGivenTo(const testing::SparseQp& flat, const OcpQp<kNx, kNu>& qp, const std::vector<double>& x) {
  const auto& first = qp.stages[0];  // x_0's share is a constant that the sparse problem leaves out
  double cost = 0.5 * qp.x0.dot(first.Q.cwiseProduct(qp.x0)) + first.q.dot(qp.x0);
  for (std::size_t k = 0; k < x.size(); ++k) cost += (0.5 * flat.H[k] * x[k] + flat.g[k]) * x[k];
  return cost;
}

template <int kNx, int kNu>
void ExpectIpoptsOptimum(const OcpQp<kNx, kNu>& qp, int instance) {
  OcpQpSolver<kNx, kNu> interior_point(qp.horizon(), {.max_working_set = 0}), solver(qp.horizon());
  const auto solve = [&](OcpQpSolver<kNx, kNu>& by) {
    ASSERT_EQ(by.Solve(qp).status, SolverStatus::kSolved) << instance;
    EXPECT_LT(EvaluateKkt(qp, by.solution()).Max(), 1e-6) << instance;
  };
  solve(interior_point);
  solve(solver);
  const testing::SparseQp flat = testing::Flatten(qp);
  const testing::IpoptResult ipopt = testing::SolveWithIpopt(flat);
  ASSERT_TRUE(ipopt.solved) << instance;
  const double cost = EvaluateCost(qp, solver.solution());
  EXPECT_NEAR(cost, CostGivenTo(flat, qp, ipopt.x), 1e-7 * std::max(1.0, std::abs(cost))) << instance;
  for (int k = 0; k < kNu; ++k) {  // every input has a curvature of at least 0.1
    const double by_ipopt = ipopt.x[static_cast<std::size_t>(k)];
    EXPECT_NEAR(solver.solution().stages[0].u[k], by_ipopt, 1e-5) << instance;
    EXPECT_NEAR(interior_point.solution().stages[0].u[k], by_ipopt, 1e-5) << instance;
  }
  // A warm start that is the solution itself, and one of nothing.
  const OcpQpPoint<kNx, kNu> optimum = solver.solution(), nothing(qp.horizon());
  for (const auto& warm_start : {optimum, nothing}) {
    ASSERT_EQ(solver.Solve(qp, &warm_start).status, SolverStatus::kSolved) << instance;
    EXPECT_LT((solver.solution().stages[0].u - optimum.stages[0].u).cwiseAbs().maxCoeff(), 1e-5) << instance;
  }
}

TEST(OcpQpSolverAgainstIpopt, FeasibleProblemsHaveTheSameOptimum) {
  Random random(1);
  for (int i = 0; i < 60; ++i) ExpectIpoptsOptimum(RandomQp<8, 2>(random, {}), i);
}

TEST(OcpQpSolverAgainstIpopt, ProblemsWithEquationsHaveTheSameOptimum) {
  Random random(2);
  for (int i = 0; i < 40; ++i) ExpectIpoptsOptimum(RandomQp<8, 2>(random, {.equalities = 0.15}), i);
}

TEST(OcpQpSolverAgainstIpopt, UnstableDynamicsHaveTheSameOptimum) {
  Random random(3);
  for (int i = 0; i < 25; ++i) {
    ExpectIpoptsOptimum(RandomQp<8, 2>(random, {.growth = 1.8, .max_horizon = 6}), i);
  }
}

TEST(OcpQpSolverAgainstIpopt, AnotherSizeHasTheSameOptimum) {
  Random random(4);
  for (int i = 0; i < 40; ++i) ExpectIpoptsOptimum(RandomQp<4, 1>(random, {}), i);
}

TEST(OcpQpSolverAgainstIpopt, ExactPenaltiesHaveTheSameOptimum) {
  Random random(6);
  for (int i = 0; i < 60; ++i) ExpectIpoptsOptimum(RandomQp<8, 2>(random, {.exact = 0.7}), i);
  for (int i = 0; i < 40; ++i) {
    ExpectIpoptsOptimum(RandomQp<4, 1>(random, {.equalities = 0.1, .exact = 1.0}), 60 + i);
  }
}

TEST(OcpQpSolverAgainstIpopt, SoftRowsWithCrossedBoundsHaveTheSameOptimum) {
  Random random(9);
  for (int i = 0; i < 40; ++i) ExpectIpoptsOptimum(RandomQp<8, 2>(random, {.exact = 0.5, .crossed = 0.3}), i);
}

template <int kNx, int kNu>
void ExpectProofOfInfeasibility(Random& random, int instance, const RandomQpOptions& options) {
  OcpQp<kNx, kNu> qp = RandomQp<kNx, kNu>(random, options);
  const double beyond = std::pow(10.0, random.Uniform(-3.0, 1.0));
  testing::MakeInfeasible(random, qp, beyond);
  OcpQpSolver<kNx, kNu> interior_point(qp.horizon(), {.max_working_set = 0}), solver(qp.horizon());
  for (auto* by : {&interior_point, &solver}) {
    EXPECT_EQ(by->Solve(qp).status, SolverStatus::kInfeasible) << instance << ": beyond reach by " << beyond;
    EXPECT_TRUE(ProvesInfeasible(qp, by->solution())) << instance;
  }
  EXPECT_FALSE(testing::SolveWithIpopt(testing::Flatten(qp)).solved) << instance;
}

TEST(OcpQpSolverAgainstIpopt, InfeasibleProblemsAreProvenAndIpoptFindsNoPointEither) {
  Random random(5);
  for (int i = 0; i < 15; ++i) {
    ExpectProofOfInfeasibility<8, 2>(random, i, {});
    ExpectProofOfInfeasibility<4, 1>(random, i, {});
  }
}

TEST(OcpQpSolverAgainstIpopt, InfeasibleProblemsWithExactPenaltiesAreProven) {
  Random random(7);
  for (int i = 0; i < 15; ++i) {
    ExpectProofOfInfeasibility<8, 2>(random, i, {.exact = 0.7});
    ExpectProofOfInfeasibility<4, 1>(random, i, {.exact = 1.0});
  }
}

}  // namespace
}  // namespace control
