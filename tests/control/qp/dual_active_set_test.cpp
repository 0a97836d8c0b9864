#include "control/qp/dual_active_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

using testing::Random;
using Result = DualActiveSet::Result;

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kTolerance = 1e-10;

struct Row {
  double lo, hi, rho, sigma, value;  // value: g_0
};

struct Problem {
  Eigen::MatrixXd M;
  std::vector<Row> rows;

  [[nodiscard]] int size() const { return static_cast<int>(rows.size()); }
};

void Give(const Problem& problem, DualActiveSet& dual) {
  dual.Clear();
  for (const Row& row : problem.rows) {
    const int j = dual.Add(row.lo, row.hi, row.rho, row.sigma, row.value);
    for (int i = 0; i <= j; ++i) dual.SetM(i, j, problem.M(i, j));
  }
}

Eigen::VectorXd Multipliers(const DualActiveSet& dual) {
  Eigen::VectorXd lambda(dual.size());
  for (int j = 0; j < dual.size(); ++j) lambda[j] = dual.lambda(j);
  return lambda;
}

// The conditions of optimality of dual_active_set.hpp.
void ExpectOptimal(const Problem& problem, const Eigen::VectorXd& lambda, int instance) {
  const Eigen::VectorXd M_lambda = problem.M * lambda;
  const double close = 1e-8 * (1.0 + M_lambda.cwiseAbs().maxCoeff());
  for (int j = 0; j < problem.size(); ++j) {
    const Row& row = problem.rows[static_cast<std::size_t>(j)];
    const double g = row.value - M_lambda[j], size = std::abs(lambda[j]);
    const double outwards = lambda[j] < 0.0 ? row.lo - g : g - row.hi;  // beyond the active bound
    const bool soft = row.rho >= 0.0;
    SCOPED_TRACE(::testing::Message() << "instance " << instance << ", row " << j << ", λ = " << lambda[j]);
    if (lambda[j] == 0.0) {
      EXPECT_LE(std::max(g - row.hi, row.lo - g), close);
    } else if (!soft || size < row.sigma) {
      EXPECT_NEAR(outwards, 0.0, close);
    } else if (row.rho == 0.0) {
      EXPECT_EQ(size, row.sigma);
      EXPECT_GE(outwards, -close);
    } else {
      EXPECT_NEAR(outwards, (size - row.sigma) / row.rho, close);
    }
  }
}

// G of `rank` columns, so that more rows than that depend on each other. Hard rows hold at λ of random size; soft ones
// need not.
Problem RandomProblem(Random& random, int size, int rank) {
  Eigen::MatrixXd G(size, rank);
  for (double& entry : G.reshaped()) entry = random.Uniform(-1.0, 1.0);
  Eigen::VectorXd inside(rank);
  for (double& entry : inside) entry = random.Uniform(-1.0, 1.0);
  Eigen::VectorXd base(rank);
  for (double& entry : base) entry = random.Uniform(-3.0, 3.0);
  Problem problem{.M = G * G.transpose(), .rows = {}};
  for (int j = 0; j < size; ++j) {
    const double at = G.row(j).dot(inside);
    Row row{.lo = -kNone, .hi = kNone, .rho = -1.0, .sigma = 0.0, .value = G.row(j).dot(base)};
    if (random.Chance(0.7)) row.hi = at + random.Uniform(0.0, 1.0);
    if (row.hi == kNone || random.Chance(0.5)) row.lo = at - random.Uniform(0.0, 1.0);
    if (random.Chance(0.15)) row.lo = row.hi = at;
    if (random.Chance(0.5)) {
      row.rho = random.Chance(0.2) ? 0.0 : std::pow(10.0, random.Uniform(-1.0, 3.0));
      if (row.rho == 0.0 || random.Chance(0.5)) row.sigma = random.Uniform(0.01, 2.0);
      if (random.Chance(0.3)) row.lo = row.hi = at + random.Uniform(-2.0, 2.0);
    }
    problem.rows.push_back(row);
  }
  return problem;
}

TEST(DualActiveSet, RandomProblemsMeetTheConditionsOfOptimality) {
  Random random(1);
  DualActiveSet dual(30);
  for (int i = 0; i < 2000; ++i) {
    const Problem problem = RandomProblem(random, random.Integer(1, 30), random.Integer(1, 30));
    Give(problem, dual);
    ASSERT_EQ(dual.Solve(kTolerance), Result::kSolved) << i;
    ExpectOptimal(problem, Multipliers(dual), i);
  }
}

TEST(DualActiveSet, TakesRowsOneByOneToTheSameSolution) {
  Random random(4);
  DualActiveSet dual(20), whole(20);
  for (int i = 0; i < 500; ++i) {
    const Problem problem = RandomProblem(random, random.Integer(2, 20), 20);  // of full rank: one solution
    Give(problem, whole);
    ASSERT_EQ(whole.Solve(kTolerance), Result::kSolved) << i;
    dual.Clear();
    for (const Row& row : problem.rows) {
      const int j = dual.Add(row.lo, row.hi, row.rho, row.sigma, row.value);
      for (int k = 0; k <= j; ++k) dual.SetM(k, j, problem.M(k, j));
      ASSERT_EQ(dual.Solve(kTolerance), Result::kSolved) << i;
    }
    const Eigen::VectorXd lambda = Multipliers(whole);
    EXPECT_LT((Multipliers(dual) - lambda).cwiseAbs().maxCoeff(), 1e-6 * (1.0 + lambda.cwiseAbs().maxCoeff()))
        << i;
  }
}

TEST(DualActiveSet, CorrectedValuesMoveTheSolution) {
  Problem problem{.M = Eigen::Matrix2d{{2.0, 1.0}, {1.0, 2.0}},
                  .rows = {{.lo = -kNone, .hi = 0.0, .rho = -1.0, .sigma = 0.0, .value = 1.0},
                           {.lo = -kNone, .hi = 0.0, .rho = -1.0, .sigma = 0.0, .value = 2.0}}};
  DualActiveSet dual(2);
  Give(problem, dual);
  ASSERT_EQ(dual.Solve(kTolerance), Result::kSolved);
  dual.Correct(0, 0.25);  // instead of 0
  dual.Correct(1, -0.25);
  ASSERT_EQ(dual.Solve(kTolerance), Result::kSolved);
  problem.rows[0].value += 0.25;
  problem.rows[1].value -= 0.25;
  ExpectOptimal(problem, Multipliers(dual), 0);
}

TEST(DualActiveSet, RayProvesThatRowsContradictEachOther) {
  Random random(5);
  DualActiveSet dual(20);
  int proven = 0;
  for (int i = 0; i < 500; ++i) {
    const int size = random.Integer(2, 20), rank = random.Integer(1, size - 1);
    Problem problem = RandomProblem(random, size, rank);
    for (Row& row : problem.rows) {
      if (row.rho < 0.0 && random.Chance(0.3)) row.lo = row.hi = row.value + random.Uniform(-1.0, 1.0);
    }
    Give(problem, dual);
    const Result result = dual.Solve(kTolerance);
    if (result == Result::kSolved) {
      ExpectOptimal(problem, Multipliers(dual), i);
      continue;
    }
    ASSERT_EQ(result, Result::kInfeasible) << i;
    ++proven;
    // The λ-weighted sum of the rows has no gradient left, and asks for less than nothing.
    Eigen::VectorXd ray(size);
    double gain = 0.0, magnitude = 0.0;
    for (int j = 0; j < size; ++j) {
      const Row& row = problem.rows[static_cast<std::size_t>(j)];
      ray[j] = dual.ray(j);
      if (ray[j] == 0.0) continue;
      EXPECT_LT(row.rho, 0.0) << i << ": a soft row is relaxed";
      const double bound = ray[j] > 0.0 ? row.hi : row.lo;
      ASSERT_TRUE(std::isfinite(bound)) << i;
      gain += ray[j] * (row.value - bound);
      magnitude += std::abs(ray[j] * (row.value - bound));
    }
    EXPECT_LT((problem.M * ray).cwiseAbs().maxCoeff(), 1e-5 * ray.cwiseAbs().maxCoeff()) << i;
    EXPECT_GT(gain, 1e-12 * magnitude) << i;
  }
  EXPECT_GT(proven, 100);
}

TEST(DualActiveSet, RestartSolvesRowsThatNearlyDependOnEachOther) {
  const Problem problem{.M = Eigen::Matrix2d{{1.0, 1.0}, {1.0, 1.0 + 1e-10}},
                        .rows = {{.lo = 0.0, .hi = 0.0, .rho = -1.0, .sigma = 0.0, .value = 1.0},
                                 {.lo = 0.0, .hi = 0.0, .rho = -1.0, .sigma = 0.0, .value = 1.0 + 1e-6}}};
  DualActiveSet dual(2);
  Give(problem, dual);
  ASSERT_EQ(dual.Solve(kTolerance), Result::kInfeasible);
  dual.Restart();
  ASSERT_EQ(dual.Solve(kTolerance), Result::kSolved);
  EXPECT_NEAR(dual.lambda(1), 1e4, 1.0);
  ExpectOptimal(problem, Multipliers(dual), 0);
  // The next problem is none of that.
  Give(problem, dual);
  EXPECT_EQ(dual.Solve(kTolerance), Result::kInfeasible);
}

TEST(DualActiveSet, RowThatNothingMovesIsContradictedOrGivesWay) {
  DualActiveSet dual(1);
  Problem problem{.M = Eigen::MatrixXd::Zero(1, 1),
                  .rows = {{.lo = -kNone, .hi = 1.0, .rho = -1.0, .sigma = 0.0, .value = 3.0}}};
  Give(problem, dual);
  EXPECT_EQ(dual.Solve(kTolerance), Result::kInfeasible);
  EXPECT_GT(dual.ray(0), 0.0);
  problem.rows[0].rho = 5.0;
  problem.rows[0].sigma = 4.0;
  Give(problem, dual);
  ASSERT_EQ(dual.Solve(kTolerance), Result::kSolved);
  EXPECT_NEAR(dual.lambda(0), 4.0 + 5.0 * 2.0, 1e-12);
  problem.rows[0].rho = 0.0;
  Give(problem, dual);
  ASSERT_EQ(dual.Solve(kTolerance), Result::kSolved);
  EXPECT_EQ(dual.lambda(0), 4.0);
}

}  // namespace
}  // namespace control
