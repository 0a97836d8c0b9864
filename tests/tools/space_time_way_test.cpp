#include "tools/scenarios/space_time_way.hpp"

#include <array>
#include <gtest/gtest.h>

#include "tools/scenarios/road_occupancy.hpp"
#include "tools/scenarios/traffic_scenario.hpp"

namespace {

using control::Obstacle;
using control::ObstacleShape;
using tools::FindSpaceTimeWay;
using tools::PossibleWay;

constexpr double kSpeed = 15.0;

// 200 m straight at 15 m/s, ±4 m, μ = 0.8: 0.7 μ g = 5.49 m/s², 20.5 m and 2.7 s to a standstill. The car is 1.8 m wide: a gap
// needs 2.0 m, and up to a cell of 15 cm more.
sim::Scenario Scenario(const control::RoadBounds& road = {.left = 4.0, .right = -4.0},
                       double curvature = 0.0) {
  const std::array pieces{
      control::RoutePiece{.length = 200.0, .curvature_from = curvature, .curvature_to = curvature}};
  sim::Scenario scenario(control::Route::FromPieces({.X = 700.0}, kSpeed, pieces), road);
  scenario.footprint = {.front = 2.0, .rear = 2.0, .half_width = 0.9};
  scenario.plant.mu = 0.8;
  scenario.PlaceVehicle(0.0, kSpeed);
  return scenario;
}

sim::Scenario With(std::vector<Obstacle> obstacles,
                   const control::RoadBounds& road = {.left = 4.0, .right = -4.0}) {
  sim::Scenario scenario = Scenario(road);
  scenario.obstacles = std::move(obstacles);
  return scenario;
}

Obstacle Wall(double X, double from, double to) {
  return {.id = 1,
          .X = X,
          .Y = 0.5 * (from + to),
          .r_x = 0.5,
          .r_y = 0.5 * (to - from),
          .shape = ObstacleShape::kBox};
}

TEST(RoadOccupancy, LeavesTheRoadWithoutWhatObjectsCover) {
  const sim::Scenario scenario = With({Wall(750.0, -4.0, 0.0)});
  const tools::RoadOccupancy occupancy(scenario, 10.0, 0.0);
  const auto free = [&](double s, double lateral) {
    return (occupancy.Free(5, s) >> occupancy.CellAt(lateral) & 1) != 0;
  };
  EXPECT_TRUE(free(30.0, 0.0));
  EXPECT_TRUE(free(30.0, 2.9));
  EXPECT_FALSE(free(30.0, 3.3)) << "the vehicle's side is beyond the edge";
  EXPECT_FALSE(free(50.0, 0.0));
  EXPECT_FALSE(free(48.0, 0.8));
  EXPECT_FALSE(free(52.0, 0.8));
  EXPECT_TRUE(free(50.0, 1.2));
  EXPECT_TRUE(free(54.0, 0.0));
  EXPECT_EQ(occupancy.Free(101, 30.0), 0u) << "nothing is known of later times";
}

TEST(RoadOccupancy, HasWhatIsPerceivedWhereItIsThen) {
  sim::Scenario scenario =
      With({{.id = 1, .X = 750.0, .Y = 0.0, .r_x = 1.0, .r_y = 1.0, .velocity_X = 10.0}});
  scenario.appears_at[1] = 2.0;
  const tools::RoadOccupancy before(scenario, 10.0, 1.9), after(scenario, 10.0, 2.0);
  const auto free = [](const tools::RoadOccupancy& occupancy, int tick, double s) {
    return (occupancy.Free(tick, s) >> occupancy.CellAt(0.0) & 1) != 0;
  };
  EXPECT_TRUE(free(before, 30, 80.0));
  EXPECT_FALSE(free(after, 30, 80.0));
  EXPECT_TRUE(free(after, 30, 50.0));
}

TEST(SpaceTimeWay, FreeRoadIsPassed) {
  EXPECT_EQ(FindSpaceTimeWay(Scenario()), PossibleWay::kPass);
  EXPECT_EQ(FindSpaceTimeWay(Scenario({.left = 1.1, .right = -1.1})), PossibleWay::kPass);
}

TEST(SpaceTimeWay, BendBeyondGripIsNone) {
  // υ² κ is 4.5 and 6.75 m/s² at the start, of 5.49.
  EXPECT_EQ(FindSpaceTimeWay(Scenario({}, 0.02)), PossibleWay::kPass);
  EXPECT_EQ(FindSpaceTimeWay(Scenario({}, 0.03)), PossibleWay::kNone);
}

TEST(SpaceTimeWay, GapMustTakeTheVehicle) {
  EXPECT_EQ(FindSpaceTimeWay(With({Wall(800.0, -4.0, 1.8)})), PossibleWay::kPass);
  EXPECT_EQ(FindSpaceTimeWay(With({Wall(800.0, -4.0, 2.1)})), PossibleWay::kStop);
}

TEST(SpaceTimeWay, WallAcrossTheRoadNeedsRoomToStop) {
  const auto at = [](double X) { return FindSpaceTimeWay(With({Wall(X, -4.0, 4.0)})); };
  EXPECT_EQ(at(735.0), PossibleWay::kStop);
  EXPECT_EQ(at(718.0), PossibleWay::kNone);
}

TEST(SpaceTimeWay, ObstacleIsNotKnownBeforeItIsPerceived) {
  sim::Scenario scenario = With({Wall(800.0, -4.0, 4.0)});  // met after 6.5 s
  scenario.appears_at[1] = 3.0;
  EXPECT_EQ(FindSpaceTimeWay(scenario), PossibleWay::kStop);
  scenario.appears_at[1] = 5.6;
  EXPECT_EQ(FindSpaceTimeWay(scenario), PossibleWay::kNone);
  scenario.appears_at[1] = 8.0;
  EXPECT_EQ(FindSpaceTimeWay(scenario), PossibleWay::kNone);
}

TEST(SpaceTimeWay, WhatIsPerceivedWhenTheEndIsReachedDoesNotMatter) {
  sim::Scenario scenario = With({Wall(690.0, -4.0, 4.0)});
  for (double appears = 13.0; appears < 14.5; appears += 0.1) {
    scenario.appears_at[1] = appears;
    EXPECT_EQ(FindSpaceTimeWay(scenario), PossibleWay::kPass) << appears;
  }
}

TEST(SpaceTimeWay, ShiftTakesTime) {
  sim::Scenario scenario = With({Wall(800.0, -4.0, 1.2)});  // a shift of 2.2 m
  scenario.appears_at[1] = 4.0;
  EXPECT_EQ(FindSpaceTimeWay(scenario), PossibleWay::kPass);
  scenario.appears_at[1] = 5.5;
  EXPECT_EQ(FindSpaceTimeWay(scenario), PossibleWay::kNone);
}

TEST(SpaceTimeWay, VehicleWaitsForWhatCrosses) {
  // It covers the whole road for 3 s from about 4 s on, when the vehicle would be there.
  Obstacle crossing = Wall(770.0, -10.0, 10.0);
  crossing.Y = -31.0;
  crossing.velocity_Y = 4.0;
  EXPECT_EQ(FindSpaceTimeWay(With({crossing})), PossibleWay::kPass);
  crossing.velocity_Y = 0.0;
  crossing.Y = 0.0;
  EXPECT_EQ(FindSpaceTimeWay(With({crossing})), PossibleWay::kStop);
}

// A slow vehicle ahead in the right lane, and one that comes in the left one: behind it the way is free.
TEST(SpaceTimeWay, OvertakingWaitsForOncomingTraffic) {
  const control::RoadBounds lanes{.left = 5.0, .right = -1.6};
  const Obstacle slow{
      .id = 1, .X = 730.0, .r_x = 2.2, .r_y = 0.9, .velocity_X = 1.0, .shape = ObstacleShape::kBox};
  const Obstacle oncoming{.id = 2,
                          .X = 800.0,
                          .Y = 3.3,
                          .r_x = 2.2,
                          .r_y = 0.9,
                          .velocity_X = -12.0,
                          .shape = ObstacleShape::kBox};
  EXPECT_EQ(FindSpaceTimeWay(With({slow, oncoming}, lanes)), PossibleWay::kPass);
  // A column of them for the whole time, and a leader that stands: one can only stop.
  std::vector<Obstacle> column{slow};
  column[0].velocity_X = 0.0;
  for (int i = 0; i < 60; ++i) {
    column.push_back(oncoming);
    column.back().id = 2 + i;
    column.back().X = 740.0 + 10.0 * i;
  }
  EXPECT_EQ(FindSpaceTimeWay(With(column, lanes)), PossibleWay::kStop);
}

TEST(SpaceTimeWay, WhoFollowsIsNotInTheWay) {
  sim::Scenario scenario = With({{.id = 1, .X = 690.0, .r_x = 2.2, .r_y = 0.9}});
  scenario.motions[1] = {.s = -10.0, .speed = {{.time = 0.0, .speed = 25.0}}, .follows = true};
  EXPECT_EQ(FindSpaceTimeWay(scenario), PossibleWay::kPass);
}

TEST(SpaceTimeWay, ObjectThatDisappearsFreesTheRoad) {
  sim::Scenario scenario = With({Wall(780.0, -4.0, 4.0)});
  EXPECT_EQ(FindSpaceTimeWay(scenario), PossibleWay::kStop);
  scenario.disappears_at[1] = 12.0;
  EXPECT_EQ(FindSpaceTimeWay(scenario), PossibleWay::kPass);
}

TEST(SpaceTimeWay, DrawnRoadsWithoutObjectsArePassed) {
  int passed = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    sim::Scenario scenario =
        tools::DrawScenario(seed, {.speed = {8.0, 20.0}, .mu = {0.4, 1.0}, .traffic = true}).scenario;
    scenario.obstacles.clear();
    scenario.appears_at.clear();
    passed += static_cast<int>(FindSpaceTimeWay(scenario) == PossibleWay::kPass);
  }
  EXPECT_EQ(passed, 40);
}

}  // namespace
