#include "control/nmpc/affine_nmpc_problem.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/mpc/road_loop.hpp"
#include "tests/control/nmpc/program_derivatives.hpp"
#include "tests/control/random.hpp"

namespace control {
namespace {

using Eigen::VectorXd;
using testing::BusyRoad;
using testing::Random;
using testing::Span;

// The problem near an obstacle, and an arbitrary point, which is no solution.
class AffineNmpcProblemTest : public ::testing::Test {
 protected:
  AffineNmpcProblemTest() {
    settings_.horizon = 5;
    loop_ = std::make_unique<BusyRoad>(settings_);
    loop_->PlaceAt(57.0, 9.0, -1.0);
    tracking_ = std::make_unique<TrackingProblem>(VehicleParameters{}, loop_->profile(), settings_);
    problem_ = std::make_unique<AffineNmpcProblem>(VehicleParameters{}, settings_);
    tracking_->Begin(loop_->z(), loop_->s(), loop_->obstacles());
    tracking_->BuildConstraints(tracking_->reference());
    problem_->Set(*tracking_, {0.02, 0.3});
    x_ = random_.Filled<Eigen::Matrix<double, 400, 1>>(0.5).head(problem_->variables());
    for (int i = 1; i <= settings_.horizon; ++i) x_[problem_->StateAt(i) + kUpsilon] += 5.0 + i;
  }

  Random random_{5};
  LpvAffineSettings settings_;
  std::unique_ptr<BusyRoad> loop_;
  std::unique_ptr<TrackingProblem> tracking_;
  std::unique_ptr<AffineNmpcProblem> problem_;
  VectorXd x_;
};

TEST_F(AffineNmpcProblemTest, GradientIsThatOfTheCost) {
  testing::ExpectGradientOfCost(*problem_, x_);
}

TEST_F(AffineNmpcProblemTest, JacobianIsThatOfTheRows) {
  testing::ExpectJacobianOfRows(*problem_, x_);
}

TEST_F(AffineNmpcProblemTest, HessianIsThatOfTheLagrangian) {
  testing::ExpectHessianOfLagrangian(*problem_, x_, random_, 1e-5);  // parts of it are differences themselves
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

// A trajectory of the model with the slacks that its violations need: no row is violated, and less slack would not do.
TEST_F(AffineNmpcProblemTest, PointOfATrajectoryHasTheSlacksThatItNeeds) {
  std::vector<State> z{tracking_->z()};
  const std::vector<Input> u(static_cast<std::size_t>(settings_.horizon), {0.02, 0.3});
  for (const Input& input : u) z.push_back(loop_->model().Step(z.back(), input));
  z.back()[kUpsilon] = tracking_->SpeedLimit(Index(settings_.horizon)) + 3.0;
  const std::vector<double> x = problem_->PointOf(z, u);
  std::vector<double> g(static_cast<std::size_t>(problem_->rows()));
  problem_->Rows(x, g);
  for (int i = 1; i <= settings_.horizon; ++i) {
    for (int soft = 0; soft < problem_->SoftRows(i); ++soft) {
      const std::size_t row = static_cast<std::size_t>(problem_->SoftRowAt(i, soft));
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
