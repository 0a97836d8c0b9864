#include "loop/route_tracker.hpp"

#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "tests/loop/fake_controller.hpp"

namespace loop {
namespace {

using control::Input;

// A route of 200 samples, each 0.5 m along X and one step of 50 ms after the last.
class RouteTrackerTest : public testing::Test {
 protected:
  static Snapshot At(std::int64_t step, double X, double Y = 0.0, double speed = 10.0) {
    Snapshot known;
    known.step = step;
    known.state_new = known.state_fresh = true;
    known.state.z << X, Y, speed, 0.0, 0.0, 0.0;
    return known;
  }
  control::RoutePlace Search(const Snapshot& known) { return tracker_.Advance(known, false, Input::Zero()); }
  control::RoutePlace Track(const Snapshot& known) { return tracker_.Advance(known, true, Input::Zero()); }

  control::TimeReference reference_{StraightRoute(), 0.05};
  control::RoadProfile profile_{StraightOn(), control::RoadBounds{.left = 4.0, .right = -4.0}, {}};
  RouteTracker tracker_{{}, reference_, profile_};
};

TEST_F(RouteTrackerTest, DisabledThePlaceIsSearchedForInEveryCycle) {
  for (const double X : {10.1, 40.1, 5.1}) {  // A search finds the vehicle behind its last place, too.
    const auto place = Search(At(7, X, 1.0));
    EXPECT_TRUE(place.on_route);
    EXPECT_EQ(place.nearest, static_cast<int>(2.0 * X));
    EXPECT_NEAR(place.s, X - 0.1, 1e-9);
    EXPECT_EQ(place.due, place.nearest);
    EXPECT_EQ(place.samples, 200);
    EXPECT_FALSE(place.arrived);
    EXPECT_EQ(tracker_.motion().p, Eigen::Vector2d(X, 1.0));
  }
  EXPECT_FALSE(Search(At(8, 10.1, 4.1)).on_route);
  Snapshot stale = At(9, 10.1);
  stale.state_fresh = false;
  EXPECT_FALSE(Search(stale).on_route);
}

TEST_F(RouteTrackerTest, EnabledTheVehicleIsBesideTheSampleOfThePreviousCycleEvenOffTheRoad) {
  EXPECT_EQ(Search(At(7, 10.1)).nearest, 20);
  const auto place = Track(At(8, 12.1));
  EXPECT_EQ(place.nearest, 20);
  EXPECT_NEAR(place.s, 10.0, 1e-9);
  EXPECT_EQ(tracker_.motion().nearest, 24);
  const auto beside = Track(At(9, 13.1, 50.0));
  EXPECT_TRUE(beside.on_route);
  EXPECT_EQ(beside.nearest, 24);
  EXPECT_EQ(Track(At(10, 13.6, 50.0)).nearest, 26);
}

TEST_F(RouteTrackerTest, DueSampleAdvancesWithTheStepsWhereverTheVehicleIs) {
  EXPECT_EQ(Search(At(7, 10.1)).due, 20);
  for (const std::int64_t step : {8, 9, 13}) {  // Three state sets are lost before the last of these steps.
    const auto place = Track(At(step, 10.1));
    EXPECT_EQ(place.due, 20 + step - 7);
    EXPECT_EQ(place.nearest, 20);
  }
  EXPECT_EQ(Search(At(14, 10.1)).due, 20);  // The next engagement counts anew.
}

TEST_F(RouteTrackerTest, WithoutANewFreshStateTheVehicleIsWhereItsCommandsTookIt) {
  static_cast<void>(Search(At(0, 10.0, 1.0)));
  for (int i = 1; i <= 20; ++i) {
    Snapshot known = At(i, 70.0, 3.0);  // This old or repeated state must not be used.
    (i % 2 == 0 ? known.state_new : known.state_fresh) = false;
    static_cast<void>(tracker_.Advance(known, true, {0.0, -2.0}));
    const double t = 0.05 * i;
    EXPECT_NEAR(tracker_.motion().p.x(), 10.0 + 10.0 * t - t * t, 1e-9);
    EXPECT_NEAR(tracker_.motion().p.y(), 1.0, 1e-9);
    EXPECT_NEAR(tracker_.motion().speed, 10.0 - 2.0 * t, 1e-9);
  }
  EXPECT_EQ(tracker_.motion().nearest, 38);  // It has come 9 m far, to the sample at 19 m.
  static_cast<void>(Track(At(21, 19.6)));
  EXPECT_EQ(tracker_.motion().p, Eigen::Vector2d(19.6, 0.0));  // A measurement replaces the reckoning.
}

TEST_F(RouteTrackerTest, VehicleHasArrivedIfItStandsWithinHalfAMetreOfTheEnd) {
  constexpr double kEnd = 99.5;
  EXPECT_TRUE(Search(At(0, kEnd - 0.4, 0.0, 0.2)).arrived);
  EXPECT_TRUE(Search(At(0, kEnd + 0.4, 2.1, 0.2)).arrived);
  EXPECT_FALSE(Search(At(0, kEnd - 0.6, 0.0, 0.2)).arrived);
  EXPECT_FALSE(Search(At(0, kEnd - 0.4, 0.0, 0.4)).arrived);
  Snapshot stale = At(0, kEnd - 0.4, 0.0, 0.2);
  EXPECT_TRUE(Track(stale).arrived);
  stale.state_fresh = false;
  EXPECT_FALSE(Track(stale).arrived);
}

TEST_F(RouteTrackerTest, OtherSettingsHoldFromTheNextCycleOn) {
  Snapshot askew = At(0, 99.2, 0.0, 0.4);
  askew.state.z[control::kPsi] = -0.6;
  EXPECT_FALSE(Search(askew).on_route);
  EXPECT_FALSE(Search(askew).arrived);
  tracker_.Reconfigure(0.7, 0.3);
  EXPECT_TRUE(Search(askew).on_route);
  EXPECT_FALSE(Search(askew).arrived);
  tracker_.Reconfigure(0.5, 0.5);
  EXPECT_FALSE(Search(askew).on_route);
  tracker_.Reconfigure(0.7, 0.5);
  EXPECT_TRUE(Search(askew).arrived);
}

// Two laps of a circuit, which begin and end at the same point.
TEST(RouteTracker, OnACircuitTheVehicleHasArrivedAfterTheLastLapOnly) {
  constexpr double kSpeed = 10.0, kPeriod = 0.05, kRadius = 20.0;
  const double lap = 2.0 * std::numbers::pi * kRadius;
  const std::vector<control::RoutePiece> pieces{
      {.length = 2.0 * lap, .curvature_from = 1.0 / kRadius, .curvature_to = 1.0 / kRadius}};
  const auto route = control::Route::FromPieces({}, kSpeed, pieces);
  const control::TimeReference reference(control::SampleRoute(route, kPeriod), kPeriod);
  const control::RoadProfile profile(route, control::RoadBounds{.left = 4.0, .right = -4.0}, {});
  RouteTracker tracker({}, reference, profile);
  const auto at = [&](double s, double speed) {
    const control::RoutePoint point = route.At(s);
    Snapshot known;
    known.state_new = known.state_fresh = true;
    known.state.z << point.X, point.Y, speed, 0.0, point.psi, 0.0;
    return known;
  };
  const auto start = tracker.Advance(at(0.0, 0.0), false, Input::Zero());
  EXPECT_TRUE(start.on_route);
  EXPECT_FALSE(start.arrived);
  for (double s = 0.0; s < 2.0 * lap; s += 0.5) {
    const auto place = tracker.Advance(at(s, 0.0), true, Input::Zero());
    EXPECT_EQ(place.arrived, s > 2.0 * lap - 0.5) << s;
  }
}

}  // namespace
}  // namespace loop
