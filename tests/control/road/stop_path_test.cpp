#include "control/road/stop_path.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <span>
#include <vector>

#include "control/road/projection.hpp"
#include "control/vehicle/blended_model.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {
namespace {

constexpr double kTs = 0.05;
constexpr double kPi = std::numbers::pi;

RoadProfile Road(double curvature, double speed) {
  const std::vector<RoutePiece> pieces{
      {.length = 300.0, .curvature_from = curvature, .curvature_to = curvature}};
  return {Route::FromPieces({}, speed, pieces), RoadBounds{.left = 8.0, .right = -8.0}, {}};
}

// The states to which these inputs lead.
std::vector<State> Simulate(State z, const std::vector<Input>& inputs) {
  const DiscreteModel model(BlendedModel(VehicleParameters{}), kTs);
  std::vector<State> states{z};
  for (const Input& u : inputs) states.push_back(z = model.Step(z, u));
  return states;
}

RouteMotion MotionOf(const State& z) {
  return {.p = Position(z),
          .psi = z[kPsi],
          .travel_direction = z[kPsi] + std::atan2(z[kNu], z[kUpsilon]),
          .speed = z[kUpsilon]};
}

// A swerve to the left and back, 40 steps at this speed.
std::vector<State> Swerve(double upsilon) {
  State z = State::Zero();
  z[kUpsilon] = upsilon;
  std::vector<Input> inputs;
  for (int i = 0; i < 40; ++i) {
    inputs.emplace_back(0.8 / upsilon * std::sin(2.0 * kPi * i / 40.0) / std::sqrt(upsilon), 0.0);
  }
  return Simulate(z, inputs);
}

TEST(StopPath, PassesThroughTheStatesOfThePlan) {
  const RoadProfile road = Road(0.0, 20.0);
  StopPath path({}, road, 40, 0.9);
  const auto plan = Swerve(20.0);
  path.Follow(plan, 0.0, {});
  double last = -1.0;
  for (const State& z : std::span(plan).first(36)) {
    const double distance = path.DistanceOf(Position(z), z[kX]);
    EXPECT_GT(distance, last);
    EXPECT_NEAR((path.At(distance).p - Position(z)).norm(), 0.0, 1e-6);
    EXPECT_NEAR(path.At(distance).direction, z[kPsi] + std::atan2(z[kNu], z[kUpsilon]), 1e-6);
    EXPECT_NEAR(path.At(distance).s, z[kX], 1e-6);
    last = distance;
  }
  EXPECT_NEAR((path.At(-3.0).p - Eigen::Vector2d(-3.0, 0.0)).norm(), 0.0, 1e-9);
}

TEST(StopPath, BeyondThePlanItRunsBesideTheRoadWithoutAKink) {
  for (const double curvature : {0.0, 0.01, -0.02}) {
    const RoadProfile road = Road(curvature, 10.0);
    StopPath path({}, road, 40, 0.9);
    State z = State::Zero();
    const RoutePoint start = road.At(30.0);
    const Eigen::Vector2d beside = Beside(start, 1.5);
    z << beside.x(), beside.y(), 10.0, 0.0, start.psi + 0.1, 0.0;
    path.Follow(Simulate(z, std::vector<Input>(4, {curvature * 2.7, 0.0})), 30.0, {});
    for (double x = 0.0; x < 60.0; x += 0.5) {
      const StopPathPoint here = path.At(x), next = path.At(x + 0.5);
      EXPECT_NEAR((next.p - here.p).norm(), 0.5, 0.03) << x;
      EXPECT_NEAR(WrapAngle(next.direction - here.direction), 0.0, 0.05) << x;
      EXPECT_NEAR(WrapAngle(std::atan2(next.p.y() - here.p.y(), next.p.x() - here.p.x()) - here.direction),
                  0.0, 0.05)
          << x;
    }
    const StopPathPoint far = path.At(60.0);
    EXPECT_NEAR(far.direction, road.At(far.s).psi, 0.01);
    EXPECT_NEAR(far.curvature, curvature, 0.002);
  }
}

// The largest distance from the path of a vehicle that brakes by 4 m/s² to a walking pace, and changes δ by at most
// 0.5 rad/s.
double Deviation(const StopPath& path, State z, double delta) {
  const DiscreteModel model(BlendedModel(VehicleParameters{}), kTs);
  double largest = 0.0;
  while (z[kUpsilon] > 1.0) {
    const double wanted = path.Steering(MotionOf(z), z[kX]);
    delta = std::clamp(wanted, delta - 0.5 * kTs, delta + 0.5 * kTs);
    z = model.Step(z, {delta, -4.0});
    const StopPathPoint there = path.At(path.DistanceOf(Position(z), z[kX]));
    largest = std::max(largest, std::abs(LeftOf(there.direction).dot(Position(z) - there.p)));
  }
  return largest;
}

TEST(StopPath, VehicleThatBrakesOnItStaysOnIt) {
  for (const double upsilon : {8.0, 15.0, 25.0}) {
    const RoadProfile road = Road(0.0, upsilon);
    StopPath path({}, road, 40, 0.9);
    const auto plan = Swerve(upsilon);
    path.Follow(plan, 0.0, {});
    for (const std::size_t begin : {0U, 10U, 20U, 30U}) {
      EXPECT_LT(Deviation(path, plan[begin], 0.0), 0.12) << upsilon << " m/s, step " << begin;
    }
  }
}

TEST(StopPath, VehicleBesideItIsSteeredBack) {
  const double curvature = 0.02, upsilon = 12.0;
  const RoadProfile road = Road(curvature, upsilon);
  StopPath path({}, road, 40, 0.9);
  State z = State::Zero();
  z << 0.0, 0.0, upsilon, 0.0, 0.0, curvature * upsilon;
  path.Follow(std::vector<State>{z}, 0.0, {});
  z[kY] = 0.5;
  const DiscreteModel model(BlendedModel(VehicleParameters{}), kTs);
  double offset = 0.5;
  while (z[kUpsilon] > 1.0) {
    z = model.Step(z, {path.Steering(MotionOf(z), z[kX]), -3.0});
    const StopPathPoint there = path.At(path.DistanceOf(Position(z), z[kX]));
    offset = LeftOf(there.direction).dot(Position(z) - there.p);
    EXPECT_LT(offset, 0.6);
    EXPECT_GT(offset, -0.1);
  }
  EXPECT_NEAR(offset, 0.0, 0.05);
}

TEST(StopPath, PlanOfAVehicleThatStandsIsAPathAlongTheRoad) {
  const RoadProfile road = Road(0.0, 10.0);
  StopPath path({}, road, 40, 0.9);
  State z = State::Zero();
  z[kY] = 1.0;
  path.Follow(std::vector<State>(41, z), 0.0, {});
  EXPECT_EQ(path.DistanceOf(Position(z), z[kX]), 0.0);
  EXPECT_NEAR((path.At(5.0).p - Eigen::Vector2d(5.0, 1.0)).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace control
