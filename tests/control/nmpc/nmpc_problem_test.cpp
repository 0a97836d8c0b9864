#include "control/nmpc/nmpc_problem.hpp"

#include <gtest/gtest.h>

#include "tests/control/differences.hpp"
#include "tests/control/mpc/closed_loop.hpp"
#include "tests/control/nmpc/program_derivatives.hpp"
#include "tests/control/random.hpp"

namespace control {
namespace {

using Curvature = SingleTrackModel::Curvature;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Differences;
using testing::ExpectClose;
using testing::Random;
using testing::Span;

State RandomState(Random& random) {
  return {random.Uniform(-50.0, 50.0), random.Uniform(-50.0, 50.0), random.Uniform(3.0, 30.0),
          random.Uniform(-2.0, 2.0),   random.Uniform(-4.0, 4.0),   random.Uniform(-1.0, 1.0)};
}

Input RandomInput(Random& random) {
  return {random.Uniform(-0.5, 0.5), random.Uniform(-6.0, 2.0)};
}

TEST(SingleTrackModel, JacobianAndHessianAreTheDerivativesOfTheMotion) {
  const SingleTrackModel model({});
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const State z = RandomState(random);
    const Input u = RandomInput(random);
    const State lambda = random.Filled<State>(1.0);
    VectorXd zu(kStates + kInputs);
    zu << z, u;
    const auto f = [&](const VectorXd& at) -> VectorXd {
      return model.Derivative(at.head<kStates>(), at.tail<kInputs>());
    };
    const auto gradient = [&](const VectorXd& at) -> VectorXd {
      const LinearModel d = model.Jacobian(at.head<kStates>(), at.tail<kInputs>());
      VectorXd sum(kStates + kInputs);
      sum << d.A.transpose() * lambda, d.B.transpose() * lambda;
      return sum;
    };
    const LinearModel d = model.Jacobian(z, u);
    MatrixXd jacobian(kStates, kStates + kInputs);
    jacobian << d.A, d.B;
    ExpectClose(jacobian, Differences(zu, f));
    ExpectClose(model.Hessian(z, u, lambda), Differences(zu, gradient));
  }
}

// A bend with two obstacles nearby, and an arbitrary point, which is no solution.
class NmpcProblemTest : public ::testing::Test {
 protected:
  NmpcProblemTest()
      : reference_(testing::PathOf(60, 12.0, [](int) { return 0.02; })), window_(Index(kHorizon) + 1) {
    settings_.horizon = kHorizon;
    problem_ = std::make_unique<NmpcProblem>(VehicleParameters{}, settings_);
    reference_.Window(20, window_);
    obstacles_ = {{.id = 4, .X = 14.0, .Y = 2.0, .r_x = 2.0, .r_y = 0.7, .heading = 0.6},
                  {.id = 7, .X = 18.0, .Y = 3.5, .r_x = 0.9, .r_y = 0.9}};
    problem_->Set(Asked());
    x_.resize(problem_->variables());
    for (int i = 0; i < kHorizon; ++i) {
      x_.segment<kInputs>(NmpcProblem::InputAt(i)) = RandomInput(random_);
      x_.segment<kStates>(NmpcProblem::StateAt(i + 1)) = RandomState(random_);
    }
  }

  static constexpr int kHorizon = 5;
  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }

  static std::vector<RoadBounds> RoadThatNarrows() {
    std::vector<RoadBounds> road;
    for (int i = 0; i <= kHorizon; ++i) road.push_back({.left = 4.0 - 0.2 * i, .right = -1.0 + 0.1 * i});
    return road;
  }
  [[nodiscard]] TrackingInput Asked() const {
    return {.z = window_[0],
            .u_previous = {0.02, 0.3},
            .reference = window_,
            .road = road_,
            .obstacles = obstacles_};
  }
  Random random_{11};
  TimeReference reference_;
  std::vector<State> window_;
  // Each step has edges of its own.
  std::vector<RoadBounds> road_ = RoadThatNarrows();
  std::vector<Obstacle> obstacles_;
  MpcSettings settings_;
  std::unique_ptr<NmpcProblem> problem_;
  VectorXd x_;
};

TEST_F(NmpcProblemTest, GradientIsThatOfTheCost) {
  testing::ExpectGradientOfCost(*problem_, x_);
}

TEST_F(NmpcProblemTest, JacobianIsThatOfTheRows) {
  testing::ExpectJacobianOfRows(*problem_, x_);
}

TEST_F(NmpcProblemTest, HessianIsThatOfTheLagrangian) {
  testing::ExpectHessianOfLagrangian(*problem_, x_, random_);
}

TEST_F(NmpcProblemTest, PatternFollowsTheNumberOfObstacles) {
  obstacles_.pop_back();
  problem_->Set(Asked());
  testing::ExpectJacobianOfRows(*problem_, x_);
}

TEST_F(NmpcProblemTest, EachStepHasTheEdgesOfTheRoadBesideIt) {
  reference_ = testing::StraightPath(60, 12.0);  // along X
  reference_.Window(0, window_);
  problem_->Set(Asked());
  const int step_rows = problem_->rows() / kHorizon;
  constexpr int kRoadRow = kStates + kInputs;
  for (int i = 0; i < kHorizon; ++i) {
    const std::size_t row = Index(i * step_rows + kRoadRow);
    EXPECT_NEAR(problem_->row_bounds().hi[row], road_[Index(i) + 1].left, 1e-12) << i;
    EXPECT_NEAR(problem_->row_bounds().lo[row], road_[Index(i) + 1].right, 1e-12) << i;
  }
}

TEST_F(NmpcProblemTest, BoxIsKeptOutsideTheEllipseThroughItsCorners) {
  const auto rows = [&] {
    problem_->Set(Asked());
    VectorXd g(problem_->rows());
    problem_->Rows(Span(std::as_const(x_)), Span(g));
    return g;
  };
  obstacles_[0].shape = ObstacleShape::kBox;
  const VectorXd of_box = rows();
  obstacles_[0].shape = ObstacleShape::kEllipse;
  EXPECT_GT((rows() - of_box).norm(), 0.1);
  obstacles_[0].r_x *= std::numbers::sqrt2;
  obstacles_[0].r_y *= std::numbers::sqrt2;
  EXPECT_LT((rows() - of_box).norm(), 1e-9);
}

TEST_F(NmpcProblemTest, ReferenceAtRestOnItselfViolatesNothingButWhatStandsInItsWay) {
  // Only on a straight does the reference obey Euler's model exactly.
  reference_ = testing::StraightPath(60, 12.0);
  reference_.Window(0, window_);
  obstacles_ = {{.id = 3, .X = 100.0, .Y = 0.0}};
  const auto violation = [&] {
    problem_->Set(Asked());
    x_.setZero();
    for (int i = 1; i <= kHorizon; ++i) x_.segment<kStates>(NmpcProblem::StateAt(i)) = window_[Index(i)];
    return problem_->LargestViolation(Span(std::as_const(x_)));
  };
  EXPECT_LT(violation().amount, 1e-9);
  EXPECT_EQ(problem_->Cost(Span(std::as_const(x_))), 0.0);

  obstacles_[0].X = window_[4][kX];
  const ConstraintViolation obstacle = violation();
  EXPECT_EQ(obstacle.constraint.kind, ConstraintKind::kObstacle);
  EXPECT_EQ(obstacle.constraint.index, 3);
  EXPECT_EQ(obstacle.constraint.step, 4);
  EXPECT_NEAR(obstacle.amount, 1.0 + settings_.obstacle_margin, 1e-9);
}

}  // namespace
}  // namespace control
