#include "control/affine_nmpc_problem.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/course_loop.hpp"
#include "tests/control/differences.hpp"
#include "tests/control/random.hpp"

namespace control {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::BusyRoad;
using testing::Differences;
using testing::ExpectClose;
using testing::Random;

std::size_t Index(int i) {
  return static_cast<std::size_t>(i);
}

std::span<const double> Span(const VectorXd& v) {
  return {v.data(), Index(static_cast<int>(v.size()))};
}

std::span<double> Span(VectorXd& v) {
  return {v.data(), Index(static_cast<int>(v.size()))};
}

// Near an obstacle, and a point that is no solution of anything.
class AffineNmpcProblemTest : public ::testing::Test {
 protected:
  AffineNmpcProblemTest() {
    settings_.horizon = 5;
    loop_ = std::make_unique<BusyRoad>(settings_);
    loop_->PlaceAt(57.0, 9.0, -1.0);
    task_ = std::make_unique<DrivingTask>(VehicleParameters{}, loop_->course(), settings_);
    problem_ = std::make_unique<AffineNmpcProblem>(VehicleParameters{}, settings_);
    task_->Begin(loop_->z(), loop_->obstacles());
    EXPECT_TRUE(task_->Bound(task_->reference()));
    problem_->Set(*task_, {0.02, 0.3});
    x_ = random_.Filled<Eigen::Matrix<double, 400, 1>>(0.5).head(problem_->variables());
    for (int i = 1; i <= settings_.horizon; ++i) x_[problem_->StateAt(i) + kUpsilon] += 5.0 + i;
  }

  [[nodiscard]] VectorXd Rows(const VectorXd& x) const {
    VectorXd g(problem_->rows());
    problem_->Rows(Span(x), Span(g));
    return g;
  }
  [[nodiscard]] VectorXd Gradient(const VectorXd& x) const {
    VectorXd gradient(problem_->variables());
    problem_->Gradient(Span(x), Span(gradient));
    return gradient;
  }
  [[nodiscard]] MatrixXd Jacobian(const VectorXd& x) const {
    VectorXd values(problem_->jacobian_pattern().size());
    problem_->Jacobian(Span(x), Span(values));
    return Dense(problem_->jacobian_pattern(), values, problem_->rows());
  }
  // Each place at most once, so a value must not meet another.
  [[nodiscard]] MatrixXd Dense(const std::vector<NonlinearProgram::Entry>& pattern, const VectorXd& values,
                               int rows) const {
    MatrixXd dense = MatrixXd::Zero(rows, problem_->variables());
    MatrixXd count = dense;
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      dense(pattern[k].row, pattern[k].column) = values[static_cast<Eigen::Index>(k)];
      count(pattern[k].row, pattern[k].column) += 1.0;
    }
    EXPECT_LE(count.maxCoeff(), 1.0);
    return dense;
  }

  Random random_{5};
  LpvAffineSettings settings_;
  std::unique_ptr<BusyRoad> loop_;
  std::unique_ptr<DrivingTask> task_;
  std::unique_ptr<AffineNmpcProblem> problem_;
  VectorXd x_;
};

TEST_F(AffineNmpcProblemTest, GradientIsThatOfTheCost) {
  const auto cost = [&](const VectorXd& x) { return VectorXd::Constant(1, problem_->Cost(Span(x))); };
  // Of a quadratic function central differences are exact but for round-off, which a cost of 1e5 makes large.
  const VectorXd gradient = Gradient(x_);
  EXPECT_LT((gradient - Differences(x_, cost).row(0).transpose()).norm(), 1e-5 * gradient.norm());
}

TEST_F(AffineNmpcProblemTest, JacobianIsThatOfTheRows) {
  ExpectClose(Jacobian(x_), Differences(x_, [&](const VectorXd& x) { return Rows(x); }));
}

TEST_F(AffineNmpcProblemTest, HessianIsThatOfTheLagrangian) {
  constexpr double kSigma = 0.7;
  VectorXd lambda(problem_->rows());
  for (double& l : lambda) l = random_.Uniform(-2.0, 2.0);
  VectorXd values(problem_->hessian_pattern().size());
  problem_->Hessian(Span(x_), kSigma, Span(std::as_const(lambda)), Span(values));
  for (const auto& [row, column] : problem_->hessian_pattern())
    EXPECT_LE(column, row) << "not the lower triangle";
  const MatrixXd lower = Dense(problem_->hessian_pattern(), values, problem_->variables());
  const MatrixXd hessian = lower.selfadjointView<Eigen::Lower>();
  ExpectClose(hessian,
              Differences(x_,
                          [&](const VectorXd& x) -> VectorXd {
                            return kSigma * Gradient(x) + Jacobian(x).transpose() * lambda;
                          }),
              1e-5);  // it is by differences itself, in part
}

TEST_F(AffineNmpcProblemTest, ObstaclesHaveRowsAndTheRoadHasOthers) {
  int road = 0, obstacles = 0;
  for (int i = 1; i <= settings_.horizon; ++i) {
    for (int soft = 0; soft < problem_->SoftRows(i); ++soft) {
      const Constraint constraint = problem_->SoftConstraint(i, soft);
      EXPECT_EQ(constraint.step, i);
      road += static_cast<int>(constraint.kind == ConstraintKind::kRoad);
      obstacles += static_cast<int>(constraint.kind == ConstraintKind::kObstacle);
    }
  }
  EXPECT_EQ(road, 2 * settings_.horizon);
  EXPECT_GT(obstacles, 0);
}

// A trajectory of the model, and slacks that make up for what it violates: no row is violated, and less slack would not do.
TEST_F(AffineNmpcProblemTest, PointOfATrajectoryHasTheSlacksThatItNeeds) {
  std::vector<State> z{task_->z()};
  const std::vector<Input> u(Index(settings_.horizon), {0.02, 0.3});
  for (const Input& input : u) z.push_back(loop_->model().Step(z.back(), input));
  z.back()[kUpsilon] = settings_.upsilon_max + 3.0;
  const std::vector<double> x = problem_->PointOf(z, u);
  std::vector<double> g(Index(problem_->rows()));
  problem_->Rows(x, g);
  for (int i = 1; i <= settings_.horizon; ++i) {
    for (int soft = 0; soft < problem_->SoftRows(i); ++soft) {
      const std::size_t row = Index(problem_->SoftRowAt(i, soft));
      EXPECT_GE(g[row], problem_->row_bounds().lo[row] - 1e-9);
      EXPECT_LE(g[row], problem_->row_bounds().hi[row] + 1e-9);
      const bool too_fast =
          i == settings_.horizon && problem_->SoftConstraint(i, soft).kind == ConstraintKind::kState;
      if (!too_fast) continue;
      EXPECT_NEAR(problem_->Slack(x, i, soft), 3.0, 1e-9);
    }
  }
}

}  // namespace
}  // namespace control
