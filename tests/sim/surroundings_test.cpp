#include "sim/surroundings.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "gtest/gtest.h"

namespace sim {
namespace {

constexpr double kRadius = 50.0;
constexpr double kLap = 2.0 * std::numbers::pi * kRadius;

control::Route TwoLaps() {
  const std::array<control::RoutePiece, 1> pieces{
      {{.length = 2.0 * kLap, .curvature_from = 1.0 / kRadius, .curvature_to = 1.0 / kRadius}}};
  return control::Route::FromPieces({}, 10.0, pieces);
}

control::Obstacle At(const control::Route& route, double s, double lateral) {
  const Eigen::Vector2d centre = control::Beside(route.At(s), lateral);
  return {.X = centre.x(), .Y = centre.y(), .r_x = 2.0, .r_y = 1.0, .heading = route.At(s).psi};
}

TEST(Surroundings, ObjectIsOnTheLapThatTheVehicleIsOn) {
  const control::Route route = TwoLaps();
  const Surroundings surroundings(route);
  const std::array<control::Obstacle, 1> objects{At(route, 60.0, 1.5)};
  EXPECT_NEAR(surroundings.OnRoad(objects, 30.0)[0]->s, 60.0, 1e-6);
  EXPECT_NEAR(surroundings.OnRoad(objects, kLap + 30.0)[0]->s, kLap + 60.0, 1e-6);
  EXPECT_NEAR(surroundings.OnRoad(objects, kLap + 30.0)[0]->lateral, 1.5, 1e-6);
}

TEST(Surroundings, ObjectBeyondTheStretchIsLeftOut) {
  const std::array<control::RoutePiece, 1> pieces{{{.length = 600.0}}};
  const control::Route route = control::Route::FromPieces({}, 10.0, pieces);
  const Surroundings surroundings(route);
  const std::array<control::Obstacle, 4> objects{At(route, 240.0, 0.0), At(route, 360.0, 0.0),
                                                 At(route, 480.0, 0.0), At(route, 520.0, 0.0)};
  const auto bodies = surroundings.OnRoad(objects, 300.0);
  ASSERT_EQ(bodies.size(), 4u);
  EXPECT_FALSE(bodies[0]);
  EXPECT_TRUE(bodies[1] && bodies[2]);
  EXPECT_FALSE(bodies[3]);
  // Behind the route's start and after its end, the road goes on.
  const std::array<control::Obstacle, 2> outside{At(route, -10.0, 0.0), At(route, 610.0, 0.0)};
  EXPECT_NEAR(surroundings.OnRoad(outside, 5.0)[0]->s, -10.0, 1e-6);
  EXPECT_NEAR(surroundings.OnRoad(outside, 590.0)[1]->s, 610.0, 1e-6);
}

TEST(RoadBody, CoversWhatIsAlongAndAcrossTheRoad) {
  const control::Route route = TwoLaps();
  control::Obstacle across = At(route, 60.0, 1.5);
  across.heading += 0.5 * std::numbers::pi;
  const Eigen::Vector2d velocity =
      3.0 * control::Along(route.At(60.0).psi) - 1.0 * control::LeftOf(route.At(60.0).psi);
  across.velocity_X = velocity.x();
  across.velocity_Y = velocity.y();
  const RoadBody body = ObjectOnRoad(across, route, {.s = 60.0, .lateral = 1.5});
  EXPECT_NEAR(body.rear, 59.0, 1e-9);
  EXPECT_NEAR(body.front, 61.0, 1e-9);
  EXPECT_NEAR(body.right, -0.5, 1e-9);
  EXPECT_NEAR(body.left, 3.5, 1e-9);
  EXPECT_NEAR(body.speed, 3.0, 1e-9);
  EXPECT_NEAR(body.lateral_speed, -1.0, 1e-9);
}

TEST(RoadBody, VehiclesCornersTurnWithItsHeading) {
  const control::Route route = TwoLaps();
  control::State z = control::State::Zero();
  z.head<2>() = control::Position(route.At(100.0));
  z[control::kPsi] = route.At(100.0).psi - 2.0 * std::numbers::pi + 0.3;
  z[control::kUpsilon] = 5.0;
  const RoadBody body = VehicleOnRoad(z, {.front = 2.0, .rear = 1.0, .half_width = 0.5}, route, {.s = 100.0});
  EXPECT_NEAR(body.heading, 0.3, 1e-9);
  EXPECT_NEAR(body.front, 100.0 + 2.0 * std::cos(0.3) + 0.5 * std::sin(0.3), 1e-9);
  EXPECT_NEAR(body.rear, 100.0 - 1.0 * std::cos(0.3) - 0.5 * std::sin(0.3), 1e-9);
  EXPECT_NEAR(body.left, 2.0 * std::sin(0.3) + 0.5 * std::cos(0.3), 1e-9);
  EXPECT_NEAR(body.right, -1.0 * std::sin(0.3) - 0.5 * std::cos(0.3), 1e-9);
  EXPECT_NEAR(body.speed, 5.0 * std::cos(0.3), 1e-9);
}

}  // namespace
}  // namespace sim
