#include "control/road/odometer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "control/vehicle/blended_model.hpp"
#include "gtest/gtest.h"
#include "tests/control/vehicle/rk4.hpp"

namespace control {
namespace {

using Eigen::Vector2d;
constexpr double kPi = std::numbers::pi;
constexpr double kTs = 0.05;
constexpr double kSpacing = 0.5;  // of the reference's samples [m]
constexpr double kRadius = 40.0;  // of the circle [m]

std::vector<Vector2d> Line(int count) {
  std::vector<Vector2d> points;
  for (int k = 0; k < count; ++k) points.emplace_back(kSpacing * k, 0.0);
  return points;
}

// The point at the angle of sample k, beside a circle to the left about the origin.
Vector2d OnCircle(double k, double radius = kRadius) {
  const double angle = k * kSpacing / kRadius;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

std::vector<Vector2d> Circle(int count) {
  std::vector<Vector2d> points;
  for (int k = 0; k < count; ++k) points.push_back(OnCircle(k));
  return points;
}

State At(const Vector2d& p, double upsilon, double nu = 0.0, double psi = 0.0) {
  State z;
  z << p.x(), p.y(), upsilon, nu, psi, 0.0;
  return z;
}

TEST(Odometer, MeasuredItMovesInTheDirectionOfTheStatesVelocity) {
  const TimeReference reference(Line(50), kTs);
  const BlendedModel model{VehicleParameters{}};
  Odometer odometer({}, kTs, reference);
  for (const double nu : {-0.8, 0.0, 0.3}) {
    const State z = At({7.0, 1.0}, 9.0, nu, 2.5);
    odometer.Start(z, 0);
    const RouteMotion& motion = odometer.motion();
    const Vector2d velocity = model.Derivative(z, Input::Zero()).head<2>();
    const Vector2d direction(std::cos(motion.travel_direction), std::sin(motion.travel_direction));
    EXPECT_LT((motion.speed * direction - velocity).norm(), 1e-12) << nu;
    EXPECT_EQ(motion.psi, 2.5);
    EXPECT_EQ(motion.p, Vector2d(7.0, 1.0));
  }
  odometer.Start(At({7.0, 1.0}, 0.1, 0.3, 2.5), 0);
  EXPECT_EQ(odometer.motion().travel_direction, 2.5) << "the sideslip of a vehicle at rest is noise";
}

// The odometer's vehicle corners steadily; in such a turn the nonlinear model must get to the same place.
TEST(Odometer, BlindItKeepsToTheNonlinearModelInATurn) {
  const TimeReference reference(Line(100), kTs);
  const BlendedModel model{VehicleParameters{}};
  for (const double speed : {3.0, 12.0}) {
    for (const double delta : {0.06, -0.06}) {
      const auto advance = [&](const State& z) {
        return testing::Rk4(z, kTs, 20, [&](const State& x) {
          return model.Derivative(x, {delta, -x[kOmega] * x[kNu]});  // υ stays the same
        });
      };
      State z = At({0.0, 0.0}, speed);
      for (int i = 0; i < 60; ++i) z = advance(z);  // the turn becomes steady
      Odometer odometer({}, kTs, reference);
      odometer.Start(z, 0);
      const Vector2d start = z.head<2>();
      const double psi = z[kPsi];
      for (int i = 0; i < 40; ++i) {
        z = advance(z);
        odometer.Advance(nullptr, {delta, 0.0});
      }
      const RouteMotion& motion = odometer.motion();
      const double way = (z.head<2>() - start).norm();
      ASSERT_GT(std::abs(z[kPsi] - psi), 0.1);
      EXPECT_NEAR(motion.psi - psi, z[kPsi] - psi, 0.01 * std::abs(z[kPsi] - psi)) << speed << ", " << delta;
      EXPECT_LT((motion.p - z.head<2>()).norm(), 0.005 * way) << speed << ", " << delta;
      EXPECT_NEAR(motion.travel_direction, z[kPsi] + std::atan2(z[kNu], z[kUpsilon]), 0.01);
    }
  }
}

TEST(Odometer, BlindItBrakesWithinTheStoppingDistanceAndStaysThere) {
  const TimeReference reference(Line(100), kTs);
  Odometer odometer({}, kTs, reference);
  const double speed = 12.0, deceleration = 3.0, psi = 0.4;
  odometer.Start(At({1.0, -2.0}, speed, 0.0, psi), 0);
  for (int i = 0; i < 85; ++i) odometer.Advance(nullptr, {0.0, -deceleration});
  const Vector2d stop =
      Vector2d(1.0, -2.0) + speed * speed / (2.0 * deceleration) * Vector2d(std::cos(psi), std::sin(psi));
  EXPECT_LT((odometer.motion().p - stop).norm(), 1e-9);
  EXPECT_EQ(odometer.motion().speed, 0.0);
  for (int i = 0; i < 20; ++i) odometer.Advance(nullptr, {0.5, -deceleration});
  EXPECT_LT((odometer.motion().p - stop).norm(), 1e-9);
  EXPECT_NEAR(odometer.motion().psi, psi, 1e-12) << "turned wheels do not turn a standing vehicle";
}

TEST(Odometer, NearestSampleFollowsTheVehicleAndDoesNotGoBack) {
  const TimeReference reference(Circle(900), kTs);  // nearly two laps
  Odometer odometer({}, kTs, reference);
  const auto beside = [](double k) { return At(OnCircle(k, kRadius - 1.5), 10.0); };
  odometer.Start(beside(530.0), 525);
  EXPECT_EQ(odometer.motion().nearest, 530);
  const auto nearest_at = [&](double k) {
    const State z = beside(k);
    odometer.Advance(&z, Input::Zero());
    return odometer.motion().nearest;
  };
  EXPECT_EQ(nearest_at(531.2), 531);
  EXPECT_EQ(nearest_at(532.8), 533);
  EXPECT_EQ(nearest_at(536.0), 536);
  EXPECT_EQ(nearest_at(534.0), 536);
}

TEST(NearestAhead, OnASecondLapIsTheSampleOfThatLap) {
  const double lap = 2.0 * kPi * kRadius / kSpacing;
  const TimeReference reference(Circle(static_cast<int>(3.0 * lap)), kTs);
  for (const int from : {0, 510, 800}) {
    for (const int ahead : {0, 1, 7, 200}) {
      for (const double radius : {kRadius - 3.0, kRadius, kRadius + 3.0}) {
        EXPECT_EQ(NearestAhead(reference, OnCircle(from + ahead, radius), from), from + ahead);
      }
    }
    EXPECT_EQ(NearestAhead(reference, OnCircle(from - 5), from), from) << "the search does not go back";
  }
}

TEST(NearestAhead, PastTheEndGoesOnAlongTheLineForAtMost2000Samples) {
  const TimeReference reference(Line(10), kTs);
  EXPECT_EQ(NearestAhead(reference, {kSpacing * 25.0, 1.0}, 4), 25);
  EXPECT_EQ(NearestAhead(reference, {kSpacing * 1e4, 0.0}, 4), 2004);
}

}  // namespace
}  // namespace control
