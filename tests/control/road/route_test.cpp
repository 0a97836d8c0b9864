#include "control/road/route.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "gtest/gtest.h"

namespace control {
namespace {

using Eigen::Vector2d;
constexpr double kPi = std::numbers::pi;

Vector2d PositionAt(const Route& route, double s) {
  const RoutePoint point = route.At(s);
  return {point.X, point.Y};
}

Route Mixed() {
  const std::vector<RoutePiece> pieces{
      {.length = 40.0},
      {.length = 30.0, .curvature_from = 0.0, .curvature_to = 0.02, .speed = 9.0},
      {.length = 60.0, .curvature_from = 0.02, .curvature_to = 0.02},
      {.length = 50.0, .curvature_from = 0.02, .curvature_to = -0.03, .speed = 14.0}};
  return Route::FromPieces({.X = 3.0, .Y = -2.0, .psi = 0.4}, 12.0, pieces);
}

TEST(Route, StraightPieceGoesAlongTheHeading) {
  const std::vector<RoutePiece> pieces{{.length = 100.0}};
  const Route route = Route::FromPieces({.X = 1.0, .Y = 2.0, .psi = kPi / 3.0}, 10.0, pieces);
  EXPECT_DOUBLE_EQ(route.length(), 100.0);
  EXPECT_NEAR(route.At(50.0).X, 26.0, 1e-12);
  EXPECT_NEAR(route.At(50.0).Y, 2.0 + 25.0 * std::sqrt(3.0), 1e-12);
}

TEST(Route, ArcLiesOnItsCircle) {
  const double radius = 50.0;
  const std::vector<RoutePiece> pieces{
      {.length = 2.0 * kPi * radius, .curvature_from = 1.0 / radius, .curvature_to = 1.0 / radius}};
  const Route route = Route::FromPieces({}, 10.0, pieces);
  for (double s = 0.0; s < route.length(); s += 7.3) {
    EXPECT_NEAR((PositionAt(route, s) - Vector2d(0.0, radius)).norm(), radius, 1e-12);
    EXPECT_NEAR(route.At(s).psi, s / radius, 1e-12);
  }
  EXPECT_NEAR(PositionAt(route, route.length()).norm(), 0.0, 1e-11);
  EXPECT_NEAR(route.At(route.length()).psi, 2.0 * kPi, 1e-12);  // not wrapped
}

// Fresnel integrals C(1), S(1) (Abramowitz and Stegun, table 7.7): psi = pi s²/2 is curvature pi s.
TEST(Route, ClothoidIsTheFresnelSpiral) {
  const std::vector<RoutePiece> pieces{{.length = 1.0, .curvature_from = 0.0, .curvature_to = kPi}};
  const RoutePoint end = Route::FromPieces({}, 1.0, pieces).At(1.0);
  EXPECT_NEAR(end.X, 0.7798934003768228, 1e-13);
  EXPECT_NEAR(end.Y, 0.4382591473903548, 1e-13);
}

TEST(Route, HeadingAndCurvatureAreTheDerivativesOfPosition) {
  const std::vector<Vector2d> waypoints{{0.0, 0.0}, {20.0, 3.0}, {35.0, 15.0}, {60.0, 12.0}, {80.0, 30.0}};
  for (const Route& route : {Mixed(), Route::ThroughWaypoints(waypoints, 10.0)}) {
    const double h = 1e-4;
    for (double s = 1.0; s < route.length() - 1.0; s += 0.7) {
      const Vector2d tangent = (PositionAt(route, s + h) - PositionAt(route, s - h)) / (2.0 * h);
      const RoutePoint point = route.At(s);
      EXPECT_NEAR(tangent.x(), std::cos(point.psi), 1e-6) << s;
      EXPECT_NEAR(tangent.y(), std::sin(point.psi), 1e-6) << s;
      EXPECT_NEAR((route.At(s + h).psi - route.At(s - h).psi) / (2.0 * h), point.curvature, 1e-4) << s;
    }
  }
}

TEST(Route, SplinePassesThroughItsWaypointsAndEndsUnbent) {
  const std::vector<Vector2d> waypoints{{0.0, 0.0}, {20.0, 3.0}, {35.0, 15.0}, {60.0, 12.0}};
  const Route route = Route::ThroughWaypoints(waypoints, 10.0);
  for (const Vector2d& waypoint : waypoints) {
    const RouteProjection nearest = route.Project(waypoint);
    EXPECT_NEAR((PositionAt(route, nearest.s) - waypoint).norm(), 0.0, 1e-9);
  }
  EXPECT_NEAR(route.At(0.0).curvature, 0.0, 1e-9);
  EXPECT_NEAR(route.At(route.length()).curvature, 0.0, 1e-9);
}

TEST(Route, SplineThroughPointsOfACircleKeepsCloseToIt) {
  std::vector<Vector2d> waypoints;
  for (int i = 0; i <= 40; ++i)
    waypoints.emplace_back(80.0 * std::sin(0.1 * i), 80.0 * (1.0 - std::cos(0.1 * i)));
  const Route route = Route::ThroughWaypoints(waypoints, 10.0);
  EXPECT_NEAR(route.length(), 320.0, 0.02);
  for (double s = 60.0; s < 260.0; s += 3.0) EXPECT_NEAR(route.At(s).curvature, 1.0 / 80.0, 1e-4);
  EXPECT_NEAR(route.At(300.0).psi - route.At(20.0).psi, 3.5, 0.01);  // continuous beyond pi
}

TEST(Route, SpeedGoesLinearlyToThatOfEachWaypoint) {
  const std::vector<Vector2d> waypoints{{0.0, 0.0}, {20.0, 3.0}, {35.0, 15.0}, {60.0, 12.0}};
  const std::vector<double> speeds{12.0, 8.0, 8.0, 20.0};
  const Route route = Route::ThroughWaypoints(waypoints, speeds);
  ASSERT_EQ(route.knots().size(), waypoints.size());
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const double s = route.knots()[i];
    EXPECT_NEAR((PositionAt(route, s) - waypoints[i]).norm(), 0.0, 1e-9) << i;
    EXPECT_NEAR(route.At(s).speed, speeds[i], 1e-9) << i;
    if (i > 0) {
      EXPECT_NEAR(route.At(0.5 * (route.knots()[i - 1] + s)).speed, 0.5 * (speeds[i - 1] + speeds[i]), 1e-9);
    }
  }
  EXPECT_NEAR(route.ArcLengthAt(route.duration()), route.length(), 1e-9);
}

TEST(Route, KnotsAreStartAndEndsOfThePieces) {
  const Route route = Mixed();
  const std::vector<double> expected{0.0, 40.0, 70.0, 130.0, 180.0};
  ASSERT_EQ(route.knots().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(route.knots()[i], expected[i], 1e-9);
}

TEST(Route, TwoWaypointsAreAStraightLine) {
  const std::vector<Vector2d> waypoints{{1.0, 1.0}, {4.0, 5.0}};
  const Route route = Route::ThroughWaypoints(waypoints, 10.0);
  EXPECT_NEAR(route.length(), 5.0, 1e-12);
  EXPECT_NEAR((PositionAt(route, 2.5) - Vector2d(2.5, 3.0)).norm(), 0.0, 1e-12);
}

TEST(Route, GoesOnStraightBeforeItsStartAndAfterItsEnd) {
  const Route route = Mixed();
  const RoutePoint end = route.At(route.length());
  const RoutePoint after = route.At(route.length() + 10.0);
  EXPECT_NEAR(after.X, end.X + 10.0 * std::cos(end.psi), 1e-12);
  EXPECT_NEAR(after.Y, end.Y + 10.0 * std::sin(end.psi), 1e-12);
  EXPECT_EQ(after.curvature, 0.0);
  EXPECT_DOUBLE_EQ(after.speed, 14.0);
  EXPECT_NEAR(route.At(-10.0).X, 3.0 - 10.0 * std::cos(0.4), 1e-12);
  EXPECT_DOUBLE_EQ(route.At(-10.0).speed, 12.0);
}

TEST(Route, SpeedGoesLinearlyToEachPiecesOwn) {
  const Route route = Mixed();
  EXPECT_NEAR(route.At(20.0).speed, 12.0, 1e-12);
  EXPECT_NEAR(route.At(55.0).speed, 10.5, 1e-12);
  EXPECT_NEAR(route.At(100.0).speed, 9.0, 1e-12);
  EXPECT_NEAR(route.At(155.0).speed, 11.5, 1e-12);
}

TEST(Route, ArcLengthMovesAtTheTargetSpeed) {
  const Route route = Mixed();
  const double h = 1e-5;
  for (double t = 0.1; t < route.duration(); t += 0.37) {
    EXPECT_NEAR((route.ArcLengthAt(t + h) - route.ArcLengthAt(t - h)) / (2.0 * h),
                route.At(route.ArcLengthAt(t)).speed, 1e-6);
  }
  EXPECT_NEAR(route.ArcLengthAt(route.duration()), route.length(), 1e-9);
}

TEST(Route, ProjectionFindsThePlaceAndTheSignedOffset) {
  const Route route = Mixed();
  std::mt19937_64 random(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  };
  for (int i = 0; i < 300; ++i) {
    const double s = uniform(-20.0, route.length() + 20.0);
    const double lateral = uniform(-8.0, 8.0);
    const RoutePoint point = route.At(s);
    const Vector2d position(point.X - lateral * std::sin(point.psi), point.Y + lateral * std::cos(point.psi));
    for (const RouteProjection& found : {route.Project(position), route.Project(position, s + 12.0)}) {
      EXPECT_NEAR(found.s, s, 1e-7);
      EXPECT_NEAR(found.lateral, lateral, 1e-9);
    }
  }
}

TEST(Route, HintKeepsTheProjectionOnItsOwnPassOfACrossing) {
  const std::vector<RoutePiece> pieces{
      {.length = 100.0},
      {.length = 1.5 * kPi * 30.0, .curvature_from = 1.0 / 30, .curvature_to = 1.0 / 30},
      {.length = 100.0}};
  const Route route = Route::FromPieces({}, 10.0, pieces);  // the last piece crosses the first
  const double second_pass = 100.0 + 1.5 * kPi * 30.0 + 30.0;
  const Vector2d crossing(70.0, 0.0);
  EXPECT_NEAR(route.Project(crossing, 70.0).s, 70.0, 1e-6);
  EXPECT_NEAR(route.Project(crossing, second_pass).s, second_pass, 1e-6);
}

TEST(SampleRoute, PointsAreReachedEveryStepAtTheTargetSpeed) {
  const std::vector<RoutePiece> pieces{{.length = 24.0}, {.length = 30.0, .speed = 6.0}};
  const Route route = Route::FromPieces({}, 12.0, pieces);
  const std::vector<Vector2d> points = SampleRoute(route, 0.05);
  EXPECT_EQ(points.size(), static_cast<std::size_t>(route.duration() / 0.05) + 1);
  for (std::size_t k = 0; k <= 40; ++k) EXPECT_NEAR(points[k].x(), 0.6 * static_cast<double>(k), 1e-9);
  for (std::size_t k = 41; k + 1 < points.size(); ++k) {
    const double speed = (points[k + 1] - points[k - 1]).norm() / 0.1;
    EXPECT_NEAR(speed, route.At(points[k].x()).speed, 1e-2);
  }
}

TEST(SampleRoute, EndOnTheGridIsAPoint) {
  const std::vector<RoutePiece> pieces{{.length = 12.0}};
  EXPECT_EQ(SampleRoute(Route::FromPieces({}, 12.0, pieces), 0.05).size(), 21u);
}

TEST(Route, ValueThatMakesNoRouteIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<RoutePiece> good{{.length = 1.0}};
  const std::vector<RoutePiece> none;
  const std::vector<RoutePiece> backwards{{.length = 1.0}, {.length = -1.0}};
  const std::vector<RoutePiece> bent{{.length = 1.0, .curvature_from = nan}};
  const std::vector<RoutePiece> stop{{.length = 1.0, .speed = 0.0}};
  EXPECT_THROW((void)Route::FromPieces({}, 0.0, good), std::invalid_argument);
  EXPECT_THROW((void)Route::FromPieces({.X = nan}, 1.0, good), std::invalid_argument);
  EXPECT_THROW((void)Route::FromPieces({}, 1.0, none), std::invalid_argument);
  EXPECT_THROW((void)Route::FromPieces({}, 1.0, backwards), std::invalid_argument);
  EXPECT_THROW((void)Route::FromPieces({}, 1.0, bent), std::invalid_argument);
  EXPECT_THROW((void)Route::FromPieces({}, 1.0, stop), std::invalid_argument);
  const std::vector<Vector2d> single{{0.0, 0.0}};
  const std::vector<Vector2d> repeated{{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}};
  const std::vector<Vector2d> infinite{{0.0, 0.0}, {nan, 0.0}};
  EXPECT_THROW((void)Route::ThroughWaypoints(single, 1.0), std::invalid_argument);
  EXPECT_THROW((void)Route::ThroughWaypoints(repeated, 1.0), std::invalid_argument);
  EXPECT_THROW((void)Route::ThroughWaypoints(infinite, 1.0), std::invalid_argument);
  const std::vector<Vector2d> two{{0.0, 0.0}, {1.0, 0.0}};
  EXPECT_NO_THROW((void)Route::ThroughWaypoints(two, std::vector{1.0, 2.0}));
  EXPECT_THROW((void)Route::ThroughWaypoints(two, std::vector{1.0}), std::invalid_argument);
  EXPECT_THROW((void)Route::ThroughWaypoints(two, std::vector{1.0, 0.0}), std::invalid_argument);
  EXPECT_THROW((void)Route::ThroughWaypoints(two, std::vector{1.0, nan}), std::invalid_argument);
}

}  // namespace
}  // namespace control
