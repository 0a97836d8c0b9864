#include "tools/scenarios/possible_way.hpp"

#include <array>
#include <gtest/gtest.h>

#include "control/road/projection.hpp"
#include "tools/scenarios/encounter.hpp"

namespace {

using control::Obstacle;
using control::PassingSide;
using tools::FindPossibleWay;
using tools::PossibleWay;

constexpr double kSpeed = 10.0;

// 100 m at 10 m/s, ±4 m, μ = 0.8: a = 5.49 m/s² on the straight. The car is 1.8 m wide: a gap needs 2.2 m.
sim::Scenario Scenario(double curvature = 0.0) {
  const std::array pieces{
      control::RoutePiece{.length = 100.0, .curvature_from = curvature, .curvature_to = curvature}};
  sim::Scenario scenario(control::Route::FromPieces({.X = 700.0}, kSpeed, pieces),
                         control::RoadBounds{.left = 4.0, .right = -4.0});
  scenario.footprint = {.front = 2.0, .rear = 2.0, .half_width = 0.9};
  scenario.plant.mu = 0.8;
  return scenario;
}

sim::Scenario With(const Obstacle& obstacle, double curvature = 0.0) {
  sim::Scenario scenario = Scenario(curvature);
  scenario.obstacles = {obstacle};
  return scenario;
}

TEST(Encounters, OfAStandingObstacleIsWhereItStands) {
  const auto encounters = tools::Encounters(With({.id = 3, .X = 750.0, .Y = -1.5, .r_x = 2.0, .r_y = 0.5}));
  ASSERT_EQ(encounters.size(), 1u);
  EXPECT_NEAR(encounters[0].time, 5.0, 1e-5);
  EXPECT_NEAR(encounters[0].s, 50.0, 1e-6);
  EXPECT_NEAR(encounters[0].lateral, -1.5, 1e-9);
  EXPECT_NEAR(encounters[0].half_length, 2.0, 1e-9);
  EXPECT_NEAR(encounters[0].half_width, 0.5, 1e-9);
  EXPECT_EQ(encounters[0].perceived_at, 0.0);
}

TEST(Encounters, OfAMovingObstacleIsWhereBothMeet) {
  // They start 60 m apart and close at 12 m/s.
  const auto encounters =
      tools::Encounters(With({.id = 3, .X = 760.0, .velocity_X = -2.0, .velocity_Y = 0.2}));
  ASSERT_EQ(encounters.size(), 1u);
  EXPECT_NEAR(encounters[0].time, 5.0, 1e-5);
  EXPECT_NEAR(encounters[0].s, 50.0, 1e-4);
  EXPECT_NEAR(encounters[0].lateral, 1.0, 1e-4);
  EXPECT_NEAR(encounters[0].velocity_along, -2.0, 1e-9);
  // Never met: one obstacle behind the start, one beyond the end.
  EXPECT_TRUE(tools::Encounters(With({.X = 690.0})).empty());
  EXPECT_TRUE(tools::Encounters(With({.X = 790.0, .velocity_X = 5.0})).empty());
}

TEST(PossibleWay, RoadWithoutObstaclesIsPassed) {
  EXPECT_EQ(FindPossibleWay(Scenario()), PossibleWay::kPass);
}

TEST(PossibleWay, GapMustTakeTheVehicleAndTwentyCentimetresOnEitherSide) {
  // 2.21 m and 2.19 m remain on the left, less on the right.
  EXPECT_EQ(FindPossibleWay(With({.X = 750.0, .Y = -1.0, .r_x = 1.0, .r_y = 2.79})), PossibleWay::kPass);
  EXPECT_EQ(FindPossibleWay(With({.X = 750.0, .Y = -1.0, .r_x = 1.0, .r_y = 2.81})), PossibleWay::kStop);
}

TEST(PossibleWay, WidthOfTheRoadCountsWhereTheObstacleIsMet) {
  // 2.3 m remain on the left where it is met; the road is half a metre narrower at its end, on the left.
  sim::Scenario scenario = With({.X = 750.0, .Y = -1.0, .r_x = 1.0, .r_y = 2.7});
  const auto narrow_from = [&](double s) {
    scenario.road = control::RoadEdges(
        std::array{control::RoadSample{.s = s}, control::RoadSample{.s = s + 1.0, .bounds = {.left = 3.5}}});
  };
  narrow_from(60.0);
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kPass);
  narrow_from(45.0);
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kStop);
}

TEST(PossibleWay, PrescribedSideIsTheOnlyOne) {
  Obstacle obstacle{.X = 750.0, .Y = -1.5, .r_x = 1.0, .r_y = 1.0};
  for (const auto& [side, way] :
       {std::pair(PassingSide::kLeft, PossibleWay::kPass), std::pair(PassingSide::kRight, PossibleWay::kStop),
        std::pair(PassingSide::kUnknown, PossibleWay::kPass)}) {
    obstacle.side = side;
    EXPECT_EQ(FindPossibleWay(With(obstacle)), way);
  }
}

TEST(PossibleWay, ShiftMustBeMadeInTheTimeSinceItIsPerceived) {
  // The shift is 0.5 + 1.5 + 1.1 - 1.0 = 2.1 m to the left: 2 sqrt(2.1 / 5.49) = 1.237 s. Stopping takes 9.1 m,
  // plus 2 m to the front end and 1 m of obstacle: 1.21 s.
  sim::Scenario scenario = With({.id = 1, .X = 750.0, .Y = -0.5, .r_x = 1.0, .r_y = 1.5});
  scenario.appears_at[1] = 5.0 - 1.25;
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kPass);
  scenario.appears_at[1] = 5.0 - 1.225;
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kStop);
  scenario.appears_at[1] = 5.0 - 1.20;
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kNone);
}

TEST(PossibleWay, BendTakesItsShareOfTheFriction) {
  // υ² κ = 4 m/s² leaves 1.49 m/s² for the shift: 2 sqrt(2.1 / 1.49) = 2.37 s instead of 1.24 s.
  sim::Scenario scenario = Scenario(0.04);
  const control::RoutePoint at = scenario.route.At(50.0);
  const Eigen::Vector2d centre = control::Beside(at, -0.5);
  scenario.obstacles = {
      {.id = 1, .X = centre.x(), .Y = centre.y(), .r_x = 1.0, .r_y = 1.5, .heading = at.psi}};
  scenario.appears_at[1] = 5.0 - 2.4;
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kPass);
  scenario.appears_at[1] = 5.0 - 2.3;
  EXPECT_NE(FindPossibleWay(scenario), PossibleWay::kPass);
  scenario.plant.mu = 0.5;  // less than the bend needs
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kNone);
}

TEST(PossibleWay, NobodyStopsBeforeAnObstacleThatComes) {
  Obstacle wall{.X = 760.0, .Y = 0.0, .r_x = 1.0, .r_y = 3.5};
  EXPECT_EQ(FindPossibleWay(With(wall)), PossibleWay::kStop);
  wall.velocity_X = -1.0;
  EXPECT_EQ(FindPossibleWay(With(wall)), PossibleWay::kNone);
  wall.velocity_X = 1.0;
  EXPECT_EQ(FindPossibleWay(With(wall)), PossibleWay::kStop);
}

TEST(PossibleWay, TwoBesideOneAnotherLeaveWhatIsBetweenThem) {
  sim::Scenario scenario = Scenario();
  const auto place = [&](double Y) {
    scenario.obstacles = {{.id = 1, .X = 750.0, .Y = Y, .r_x = 1.0, .r_y = 1.5},
                          {.id = 2, .X = 752.0, .Y = -Y, .r_x = 1.0, .r_y = 1.5}};
  };
  place(2.65);  // 2.3 m between them
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kPass);
  place(2.55);  // 2.1 m
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kStop);
  scenario.obstacles[1].X = 770.0;  // one after the other
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kPass);
}

TEST(PossibleWay, FirstObstacleWithoutAWayPastDecides) {
  sim::Scenario scenario = Scenario();
  scenario.obstacles = {{.id = 1, .X = 780.0, .Y = 0.0, .r_x = 1.0, .r_y = 3.5, .velocity_X = -1.0},
                        {.id = 2, .X = 740.0, .Y = 0.0, .r_x = 1.0, .r_y = 3.5}};
  EXPECT_EQ(FindPossibleWay(scenario), PossibleWay::kStop);
}

}  // namespace
