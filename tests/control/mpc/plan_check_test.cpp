#include "control/mpc/plan_check.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace control {
namespace {

constexpr int kSteps = 40;

class PlanCheckTest : public testing::Test {
 protected:
  static RoadProfile StraightCourse() {
    const std::array pieces{
        RoutePiece{.length = 300.0, .curvature_from = 0.0, .curvature_to = 0.0, .speed = {}}};
    return RoadProfile(Route::FromPieces({.X = 0.0, .Y = 0.0, .psi = 0.0}, 15.0, pieces), RoadBounds{},
                       SpeedLimits{});
  }
  static State At(double X, double Y, double psi = 0.0) {
    State z;
    z << X, Y, 15.0, 0.0, psi, 0.0;
    return z;
  }
  static std::vector<Input> Constant(double delta, double a) {
    return std::vector<Input>(kSteps, Input(delta, a));
  }

  RoadProfile profile_ = StraightCourse();
  Footprint footprint_{.front = 1.95, .rear = 2.3, .half_width = 0.9};
  PlanCheck check_{{.vehicle = {}, .footprint = footprint_, .mu = 0.7, .t_s = 0.05}, profile_};
};

TEST_F(PlanCheckTest, StraightOnAnEmptyRoadIsFine) {
  EXPECT_FALSE(check_.Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), {}));
}

TEST_F(PlanCheckTest, AnObstacleIsTouchedByTheFrontAndNotByTheCentreOfGravity) {
  const std::array obstacles{Obstacle{.id = 7, .X = 50.0, .Y = 0.0, .r_x = 1.0, .r_y = 0.5}};
  const auto violation = check_.Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), obstacles);
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.kind, ConstraintKind::kObstacle);
  EXPECT_EQ(violation->constraint.index, 7);
  // The front is at 20 + 1.95 + 0.75 i [m], the obstacle's edge at 49 m.
  EXPECT_EQ(violation->constraint.step, static_cast<int>(std::ceil((49.0 - 21.95) / 0.75)));
  EXPECT_GT(violation->amount, 0.0);
}

TEST_F(PlanCheckTest, AnObstacleInsideTheRectangleIsTouched) {
  // It is so small, and so far from the edges at both steps, that no edge of the rectangle meets it.
  const std::array obstacles{Obstacle{.id = 1, .X = 20.75, .Y = 0.0, .r_x = 0.05, .r_y = 0.05}};
  const auto violation = check_.Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), obstacles);
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.step, 1);
}

TEST_F(PlanCheckTest, PassingByLessThanAWidthIsTouching) {
  const auto passed_at = [&](double Y) {
    const std::array obstacles{Obstacle{.id = 1, .X = 40.0, .Y = Y, .r_x = 1.0, .r_y = 0.5}};
    return check_.Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), obstacles).has_value();
  };
  EXPECT_TRUE(passed_at(1.39));
  EXPECT_FALSE(passed_at(1.41));
  EXPECT_TRUE(passed_at(-1.39));
  EXPECT_FALSE(passed_at(-1.41));
}

TEST_F(PlanCheckTest, AMovingObstacleIsMetWhereItWillBe) {
  // Once moving, it enters the road and is there at the same time as the vehicle.
  Obstacle crossing{.id = 3, .X = 35.0, .Y = -5.0, .r_x = 0.5, .r_y = 0.5};
  EXPECT_FALSE(check_.Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), std::array{crossing}));
  crossing.velocity_Y = 5.0;
  EXPECT_TRUE(check_.Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), std::array{crossing}));
}

TEST_F(PlanCheckTest, ACornerOffTheRoadIsNamedWithItsStep) {
  const double psi = 0.1;
  const auto violation = check_.Validate(At(20.0, 0.0, psi), 20.0, Constant(0.0, 0.0), {});
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.kind, ConstraintKind::kRoad);
  // The front left corner is off the road once 1.95 sin ψ + 0.9 cos ψ + 0.75 i sin ψ exceeds 4 m.
  const double needed = (4.0 - 1.95 * std::sin(psi) - 0.9 * std::cos(psi)) / (0.75 * std::sin(psi));
  EXPECT_NEAR(violation->constraint.step, needed, 1.5);
}

TEST_F(PlanCheckTest, WhoIsOffTheRoadMayComeBack) {
  EXPECT_FALSE(check_.Validate(At(20.0, 3.3, -0.05), 20.0, Constant(0.0, 0.0), {}));
  EXPECT_TRUE(check_.Validate(At(20.0, 3.3, 0.05), 20.0, Constant(0.0, 0.0), {}));
}

TEST_F(PlanCheckTest, MoreThanTheTyresGiveIsFriction) {
  const auto violation = check_.Validate(At(20.0, 0.0), 20.0, Constant(0.12, 0.0), {});
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.kind, ConstraintKind::kFriction);
  EXPECT_TRUE(check_.Validate(At(20.0, 0.0), 20.0, Constant(0.0, -7.5), {}));
  EXPECT_FALSE(check_.Validate(At(20.0, 0.0), 20.0, Constant(0.0, -6.0), {}));
}

}  // namespace
}  // namespace control
