#include "control/road/road_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gtest/gtest.h"
#include "tests/control/narrowing.hpp"
#include "tests/control/roads.hpp"

namespace control {
namespace {

using testing::CircularRoad;
using testing::HairpinRoad;
using testing::StraightRoad;
using testing::WindingRoad;

constexpr double kRadius = 25.0;
constexpr double kPi = std::numbers::pi;

Eigen::Vector2d Beside(const RoutePoint& point, double lateral) {
  return {point.X - lateral * std::sin(point.psi), point.Y + lateral * std::cos(point.psi)};
}

TEST(RoadProfile, PointsAreThoseOfTheRouteWithinTheSagittaOfItsSamples) {
  const Route route = WindingRoad(kRadius, 12.0);
  const RoadProfile profile(route, {}, {});
  const double sagitta = RoadProfile::kSpacing * RoadProfile::kSpacing / (8.0 * kRadius);
  for (double s = -20.0; s < route.length() + 20.0; s += 0.13) {
    const RoutePoint exact = route.At(s), point = profile.At(s);
    EXPECT_LT(std::hypot(point.X - exact.X, point.Y - exact.Y), 1.1 * sagitta) << s;
    EXPECT_NEAR(point.psi, exact.psi, 1e-3) << s;
    EXPECT_NEAR(point.curvature, exact.curvature, 2e-3) << s;
  }
}

TEST(RoadProfile, ProjectionFindsPlaceAndLateralOffsetOfAPointBesideTheCourse) {
  for (const Route& route :
       {StraightRoad(30.0, 12.0), WindingRoad(kRadius, 12.0), CircularRoad(kRadius, 0.6, 12.0)}) {
    const RoadProfile profile(route, {}, {});
    for (double s = -6.0; s < route.length() + 6.0; s += 0.37) {
      for (const double lateral : {-3.5, -1.0, 0.0, 1.0, 3.5}) {
        for (const double hint : {s - 4.0, s, s + 4.0}) {
          const RouteProjection place = profile.Project(Beside(route.At(s), lateral), hint);
          EXPECT_NEAR(place.s, s, 0.05) << "lateral " << lateral << ", hint " << hint;
          EXPECT_NEAR(place.lateral, lateral, 0.005) << "at " << s << ", hint " << hint;
        }
      }
    }
  }
}

TEST(RoadProfile, WithLessGripBendsAreSlowerAndBrakingBeforeThemIsMilder) {
  const RoadProfile profile(WindingRoad(kRadius, 12.0), {}, {.lateral = 3.0, .deceleration = 2.0});
  const double whole = std::hypot(3.0, 2.0) / 0.9, half = 0.5 * whole;
  for (double s = -5.0; s < profile.length() + 5.0; s += 0.37) {
    EXPECT_EQ(profile.SpeedWithin(whole, s), profile.At(s).speed) << s;
    const double v = profile.SpeedWithin(half, s), next = profile.SpeedWithin(half, s + 0.5);
    EXPECT_LE(v, profile.At(s).speed) << s;
    EXPECT_LE(v * v * std::abs(profile.At(s).curvature), 0.5 * 3.0 + 0.02) << s;
    EXPECT_GE(next * next, v * v - 2.0 * 0.5 * 2.0 * 0.5 - 1e-9) << s;
  }
}

TEST(RoadProfile, ProjectionStaysOnTheLegThatTheHintIsOn) {
  const Route route = HairpinRoad(60.0, 6.0, 5.0);
  const RoadProfile profile(route, {}, {});
  const Eigen::Vector2d between(20.0, 3.0);
  EXPECT_NEAR(profile.Project(between, 22.0).s, 20.0, 0.05);
  const double back = route.length() - 20.0;
  EXPECT_NEAR(profile.Project(between, back - 2.0).s, back, 0.05);
}

TEST(RoadProfile, TurnsAlongAPartOfItByTheAngleBetweenItsDirections) {
  const Route route = CircularRoad(kRadius, 0.6, 12.0);
  const RoadProfile profile(route, {}, {});
  const double s = 0.5 * route.length(), within = profile.TurnWithin(s, 3.0);
  EXPECT_GE(within, 6.0 / kRadius - 1e-9);
  EXPECT_LT(within, (6.0 + 2.0 * RoadProfile::kSpacing) / kRadius + 1e-9);  // whole samples
  EXPECT_EQ(RoadProfile(StraightRoad(30.0, 12.0), {}, {}).TurnWithin(10.0, 3.0), 0.0);
  EXPECT_EQ(profile.TurnWithin(-10.0, 3.0), 0.0);
}

TEST(RoadProfile, SpeedKeepsToTheTargetTheCurvesAndTheBrakes) {
  const SpeedLimits limits{.lateral = 2.0, .acceleration = 1.5, .deceleration = 2.5};
  const Route route = WindingRoad(kRadius, 14.0);
  const RoadProfile profile(route, {}, limits);
  const double in_the_curve = std::sqrt(limits.lateral * kRadius);
  double fastest = 0.0;
  constexpr double kStep = 0.1;
  for (double s = 0.0; s + kStep < route.length(); s += kStep) {
    const RoutePoint point = profile.At(s);
    const double next = profile.At(s + kStep).speed;
    EXPECT_LE(point.speed, 14.0 + 1e-9);
    // Between two samples both factors are interpolated.
    EXPECT_LE(point.speed * point.speed * std::abs(point.curvature), 1.01 * limits.lateral) << s;
    EXPECT_GE((next * next - point.speed * point.speed) / (2.0 * kStep), -limits.deceleration - 1e-9) << s;
    fastest = std::max(fastest, point.speed);
  }
  EXPECT_NEAR(fastest, 14.0, 1e-9);
  EXPECT_NEAR(profile.At(85.0).speed, in_the_curve, 1e-9);
  EXPECT_NEAR(profile.At(route.length() - 10.0).speed, std::sqrt(2.0 * 2.5 * 10.0), 1e-6);
  EXPECT_EQ(profile.At(route.length()).speed, 0.0);
  EXPECT_EQ(profile.At(route.length() + 5.0).speed, 0.0);
  EXPECT_EQ(profile.At(-5.0).speed, profile.At(0.0).speed);
}

TEST(RoadProfile, EdgesAreThoseOfTheRoadAtEachPlace) {
  const RoadProfile profile(WindingRoad(kRadius, 12.0), testing::NarrowingOnTheRight(50.2, 60.2, -1.0), {});
  EXPECT_EQ(profile.RoadAt(-5.0).right, -4.0);
  EXPECT_NEAR(profile.RoadAt(51.2).right, -3.7, 1e-12);
  EXPECT_NEAR(profile.RoadAt(55.2).right, -2.5, 1e-12);
  EXPECT_EQ(profile.RoadAt(profile.length() + 5.0).right, -1.0);
  EXPECT_EQ(profile.RoadAt(55.2).left, 4.0);
}

TEST(RoadProfile, SlowerPieceIsReachedSlowly) {
  const Route route =
      Route::FromPieces({}, 12.0,
                        std::array{RoutePiece{.length = 60.0}, RoutePiece{.length = 0.4, .speed = 4.0},
                                   RoutePiece{.length = 60.0}});
  const RoadProfile profile(route, {}, {.lateral = 3.0, .acceleration = 1.5, .deceleration = 2.0});
  EXPECT_NEAR(profile.At(61.0).speed, 4.0, 1e-9);
  EXPECT_NEAR(profile.At(50.0).speed, std::sqrt(16.0 + 4.0 * 10.5), 0.1);
}

TEST(StoppingSpeed, IsThatFromWhichTheBrakesStopInTime) {
  for (const double distance : {0.3, 1.0, 25.0}) {
    const double speed = StoppingSpeed(distance, 2.0);
    EXPECT_NEAR(speed * speed / (2.0 * 2.0), distance, 1e-12);
  }
  for (const double distance : {RoadProfile::kStopWithin, 0.1, 0.0, -3.0})
    EXPECT_EQ(StoppingSpeed(distance, 2.0), 0.0);
}

}  // namespace
}  // namespace control
