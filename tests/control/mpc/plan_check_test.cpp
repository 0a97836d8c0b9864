#include "control/mpc/plan_check.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "control/road/projection.hpp"
#include "control/vehicle/steady_cornering.hpp"
#include "tests/control/narrowing.hpp"
#include "tests/control/roads.hpp"

namespace control {
namespace {

constexpr int kSteps = 40;

class PlanCheckTest : public ::testing::Test {
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

  std::optional<ConstraintViolation> Validate(const State& z, double s, std::span<const Input> u,
                                              std::span<const Obstacle> obstacles,
                                              const Disturbance& disturbance = {},
                                              double mu_limit = kNoLimit) {
    check_.Begin(z, s, obstacles, disturbance, mu_limit);
    return check_.Validate(u);
  }

  RoadProfile profile_ = StraightCourse();
  Footprint footprint_{.front = 1.95, .rear = 2.3, .half_width = 0.9};
  PlanCheck check_{{.vehicle = {}, .footprint = footprint_, .mu = 0.7, .t_s = 0.05}, profile_};
};

TEST_F(PlanCheckTest, StraightOnAnEmptyRoadIsFine) {
  EXPECT_FALSE(Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), {}));
}

TEST_F(PlanCheckTest, AnObstacleIsTouchedByTheFrontAndNotByTheCentreOfGravity) {
  const std::array obstacles{Obstacle{.id = 7, .X = 50.0, .Y = 0.0, .r_x = 1.0, .r_y = 0.5}};
  const auto violation = Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), obstacles);
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
  const auto violation = Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), obstacles);
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.step, 1);
}

TEST_F(PlanCheckTest, PassingByLessThanAWidthIsTouching) {
  const auto passed_at = [&](double Y) {
    const std::array obstacles{Obstacle{.id = 1, .X = 40.0, .Y = Y, .r_x = 1.0, .r_y = 0.5}};
    return Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), obstacles).has_value();
  };
  EXPECT_TRUE(passed_at(1.39));
  EXPECT_FALSE(passed_at(1.41));
  EXPECT_TRUE(passed_at(-1.39));
  EXPECT_FALSE(passed_at(-1.41));
}

TEST_F(PlanCheckTest, ACornerOfABoxIsTouchedWhereAnEllipseWouldNotBe) {
  Obstacle obstacle{.id = 5, .X = 40.0, .r_x = 3.0, .r_y = 1.2, .heading = 0.2};
  const auto passed = [&] {
    return !Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), std::array{obstacle}).has_value();
  };
  const double ellipse = std::hypot(3.0 * std::sin(0.2), 1.2 * std::cos(0.2));
  const double box = 3.0 * std::sin(0.2) + 1.2 * std::cos(0.2);
  for (const auto& [shape, half_width] :
       {std::pair{ObstacleShape::kEllipse, ellipse}, std::pair{ObstacleShape::kBox, box}}) {
    obstacle.shape = shape;
    obstacle.Y = 0.9 + half_width + 0.01;
    EXPECT_TRUE(passed());
    obstacle.Y = 0.9 + half_width - 0.01;
    EXPECT_FALSE(passed());
  }
}

TEST_F(PlanCheckTest, AMovingObstacleIsMetWhereItWillBe) {
  // Once moving, it enters the road and is there at the same time as the vehicle.
  Obstacle crossing{.id = 3, .X = 35.0, .Y = -5.0, .r_x = 0.5, .r_y = 0.5};
  EXPECT_FALSE(Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), std::array{crossing}));
  crossing.velocity_Y = 5.0;
  EXPECT_TRUE(Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), std::array{crossing}));
}

TEST_F(PlanCheckTest, WhoFollowsInTheSameLaneOrStandsOffTheRoadIsNotTheVehiclesConcern) {
  Obstacle behind{.id = 4, .X = 8.0, .Y = 0.3, .r_x = 2.5, .r_y = 0.9, .velocity_X = 20.0};
  EXPECT_FALSE(Validate(At(20.0, 0.0), 20.0, Constant(0.0, -3.0), std::array{behind}));
  behind.Y = 2.5;
  EXPECT_TRUE(Validate(At(20.0, 0.0), 20.0, Constant(0.05, -3.0), std::array{behind}))
      << "whose lane the vehicle enters";
}

TEST_F(PlanCheckTest, OncomingObstacleFollowsTheBendOfTheRoad) {
  const std::array pieces{RoutePiece{.length = 200.0, .curvature_from = 0.02, .curvature_to = 0.02}};
  const RoadProfile bend(Route::FromPieces({}, 12.0, pieces), RoadBounds{.left = 6.0, .right = -2.0}, {});
  PlanCheck check({.vehicle = {}, .footprint = footprint_, .mu = 0.7, .t_s = 0.05}, bend);
  const RoutePoint there = bend.At(45.0);
  const Eigen::Vector2d centre = Beside(there, 3.5);
  const Obstacle oncoming{.id = 1,
                          .X = centre.x(),
                          .Y = centre.y(),
                          .r_x = 2.3,
                          .r_y = 1.0,
                          .heading = there.psi,
                          .velocity_X = -12.0 * std::cos(there.psi),
                          .velocity_Y = -12.0 * std::sin(there.psi)};
  State z = At(0.0, 0.0);
  z[kUpsilon] = 12.0;
  z[kOmega] = 0.24;
  z[kNu] = z[kUpsilon] * 0.02 * SideslipPerCurvature({}, 12.0);
  z[kPsi] = -z[kNu] / z[kUpsilon];
  const std::vector<Input> steady(kSteps, Input(0.02 * SteeringPerCurvature({}, 12.0), 0.0));
  check.Begin(z, 0.0, std::array{oncoming});
  EXPECT_FALSE(check.Validate(steady)) << "on a straight line it would come into the vehicle's lane";
}

TEST_F(PlanCheckTest, ACornerOffTheRoadIsNamedWithItsStep) {
  const double psi = 0.1;
  const auto violation = Validate(At(20.0, 0.0, psi), 20.0, Constant(0.0, 0.0), {});
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.kind, ConstraintKind::kRoad);
  // The front left corner is off the road once 1.95 sin ψ + 0.9 cos ψ + 0.75 i sin ψ exceeds 4 m.
  const double needed = (4.0 - 1.95 * std::sin(psi) - 0.9 * std::cos(psi)) / (0.75 * std::sin(psi));
  EXPECT_NEAR(violation->constraint.step, needed, 1.5);
}

// Whatever the road's bend and the vehicle's heading, the plan is refused at the step at which a corner leaves the road.
TEST_F(PlanCheckTest, InABendACornerIsOffTheRoadFromTheSameStepOnAsItsPlaceOnTheRoad) {
  const DiscreteModel model(BlendedModel(VehicleParameters{}), 0.05);
  for (const double radius : {12.0, 25.0, 60.0}) {
    const RoadProfile bend(testing::CircularRoad(radius, 1.0, 12.0), RoadBounds{}, SpeedLimits{});
    PlanCheck check{{.vehicle = {}, .footprint = footprint_, .mu = 2.0, .t_s = 0.05}, bend};
    for (const double delta : {-0.05, 0.0, 0.05, 0.2, 0.3}) {
      const RoutePoint start = bend.At(4.0);
      State z;
      z << start.X, start.Y, 7.0, 0.0, start.psi, 0.0;
      const std::vector<Input> u = Constant(delta, 0.0);
      check.Begin(z, 4.0, {});
      const auto violation = check.Validate(u);
      int first = 0;
      for (int step = 1; step <= kSteps && first == 0; ++step) {
        z = model.Step(z, u[0]);
        for (const Eigen::Vector2d& corner : footprint_.Corners()) {
          const RouteProjection place =
              bend.Project(Position(z) + Rotate(z[kPsi], corner), 4.0 + 0.35 * step);
          if (std::abs(place.lateral) > 4.0 + 0.02) first = step;
        }
      }
      EXPECT_EQ(violation ? violation->constraint.step : 0, first) << radius << " m, " << delta << " rad";
    }
  }
}

TEST_F(PlanCheckTest, WhoIsOffTheRoadMayComeBack) {
  EXPECT_FALSE(Validate(At(20.0, 3.3, -0.05), 20.0, Constant(0.0, 0.0), {}));
  EXPECT_TRUE(Validate(At(20.0, 3.3, 0.05), 20.0, Constant(0.0, 0.0), {}));
}

TEST_F(PlanCheckTest, DisturbanceMayDriveThePlanOffTheRoad) {
  const Disturbance offset{.delta_0 = 0.03};
  EXPECT_FALSE(Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), {}));
  const auto violation = Validate(At(20.0, 0.0), 20.0, Constant(0.0, 0.0), {}, offset);
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.kind, ConstraintKind::kRoad);
  EXPECT_FALSE(Validate(At(20.0, 0.0), 20.0, Constant(-0.03, 0.0), {}, offset));
}

// At 15 m/s the vehicle stops within 22 m; half a second are 7.5 m.
TEST_F(PlanCheckTest, StopLastsIfItMayBeginHalfASecondLater) {
  const auto stop_before = [&](double X) {
    const std::array wall{Obstacle{.id = 1, .X = X + 1.0, .Y = 0.0, .r_x = 1.0, .r_y = 4.0}};
    check_.Begin(At(20.0, 0.0), 20.0, wall);
    static_cast<void>(check_.Validate(Constant(0.0, 0.0)));
    return check_.FindStop();
  };
  EXPECT_FALSE(stop_before(40.0).deceleration);
  const StopVerdict near = stop_before(48.5), far = stop_before(70.0);
  EXPECT_TRUE(near.deceleration);
  EXPECT_FALSE(near.lasts);
  EXPECT_TRUE(far.deceleration);
  EXPECT_TRUE(far.lasts);
}

TEST_F(PlanCheckTest, FrictionThatIsFeltToBeLessCounts) {
  const std::vector<Input> brake = Constant(0.0, -4.0);
  EXPECT_FALSE(Validate(At(20.0, 0.0), 20.0, brake, {}, {}, 0.8));
  const auto violation = Validate(At(20.0, 0.0), 20.0, brake, {}, {}, 0.35);
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.kind, ConstraintKind::kFriction);
  EXPECT_NEAR(violation->amount, 4.0 - 0.35 * kGravity, 1e-9);
}

TEST_F(PlanCheckTest, MoreThanTheDrivenAxleGivesIsFriction) {
  VehicleParameters vehicle;
  for (const auto& [driven, fits] :
       {std::pair(DrivenAxle::kBoth, true), std::pair(DrivenAxle::kRear, false)}) {
    vehicle.driven = driven;
    PlanCheck check({.vehicle = vehicle, .footprint = footprint_, .mu = 0.2}, profile_);
    check.Begin(At(20.0, 0.0), 20.0, {});
    const auto violation = check.Validate(Constant(0.0, 1.5));
    EXPECT_EQ(!violation, fits);
    if (!fits) {
      ASSERT_TRUE(violation);
      EXPECT_EQ(violation->constraint.kind, ConstraintKind::kFriction);
    }
    check.Begin(At(20.0, 0.0), 20.0, {});
    EXPECT_FALSE(check.Validate(Constant(0.0, -1.5))) << "all brake";
  }
}

TEST_F(PlanCheckTest, MoreThanTheTyresGiveIsFriction) {
  const auto violation = Validate(At(20.0, 0.0), 20.0, Constant(0.12, 0.0), {});
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.kind, ConstraintKind::kFriction);
  EXPECT_TRUE(Validate(At(20.0, 0.0), 20.0, Constant(0.0, -7.5), {}));
  EXPECT_FALSE(Validate(At(20.0, 0.0), 20.0, Constant(0.0, -6.0), {}));
}

TEST_F(PlanCheckTest, ACornerInANarrowingIsOffTheRoadByTheEdgeBesideIt) {
  // The right edge is at −4 + 0.1 (s − 40) from s = 40 m to 75 m: beside the vehicle's side, at −0.9 m, at s = 71 m.
  const std::array pieces{RoutePiece{.length = 300.0}};
  const RoadProfile narrowing(Route::FromPieces({}, 15.0, pieces),
                              testing::NarrowingOnTheRight(40.0, 75.0, -0.5), {});
  PlanCheck check({.vehicle = {}, .footprint = footprint_, .mu = 0.7, .t_s = 0.05}, narrowing);
  const auto validate = [&](double Y) {
    check.Begin(At(45.0, Y), 45.0, {});
    return check.Validate(Constant(0.0, 0.0));
  };
  const auto violation = validate(0.0);
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->constraint.kind, ConstraintKind::kRoad);
  // The front is at 46.95 + 0.75 i [m] and may be 0.02 m beyond the edge.
  EXPECT_EQ(violation->constraint.step, static_cast<int>(std::ceil((71.0 + 0.2 - 46.95) / 0.75)));
  EXPECT_NEAR(violation->amount, 0.1 * (46.95 + 0.75 * violation->constraint.step - 71.0), 1e-3);
  EXPECT_FALSE(validate(0.5)) << "half a metre to the left, it fits";
}

TEST_F(PlanCheckTest, WhereTheRoadHasWidenedItsWidthCounts) {
  const std::array pieces{RoutePiece{.length = 300.0}};
  const std::array samples{RoadSample{.s = 30.0, .bounds = {.left = 1.0, .right = -1.0}},
                           RoadSample{.s = 40.0, .bounds = {.left = 4.0, .right = -4.0}}};
  const RoadProfile widening(Route::FromPieces({}, 15.0, pieces), RoadEdges(samples), {});
  PlanCheck check({.vehicle = {}, .footprint = footprint_, .mu = 0.7, .t_s = 0.05}, widening);
  const auto leaves = [&](const State& z) {
    check.Begin(z, z[kX], {});
    return check.Validate(Constant(0.0, 0.0)).has_value();
  };
  EXPECT_FALSE(leaves(At(45.0, 2.0)));
  EXPECT_FALSE(leaves(At(10.0, 0.0)));
  EXPECT_TRUE(leaves(At(10.0, 0.0, 0.03)));
}

}  // namespace
}  // namespace control
