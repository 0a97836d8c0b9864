// A vehicle on a straight road and what its traffic planner decides, for tests.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "control/traffic/speed_plan.hpp"
#include "control/traffic/traffic_planner.hpp"
#include "gtest/gtest.h"
#include "tests/control/roads.hpp"

namespace control::testing {

// A straight road in X direction from −4 m to 4 m, on which the vehicle of width 1.8 m is at X = 50 m.
class PlannedTraffic : public ::testing::Test {
 protected:
  static constexpr double kSpeed = 12.0;
  static constexpr double kHalfWidth = 0.9;
  static constexpr double kPlace = 50.0;
  static constexpr double kStep = 0.1;  // of a drive [s]
  static constexpr TrafficSettings kSettings{
      .footprint = {.front = 2.0, .rear = 2.3, .half_width = kHalfWidth},
      .obstacle_margin = 0.3,
      .road_margin = 0.1,
      .grip = 5.0,
      .path = {}};

  explicit PlannedTraffic(const RoadEdges& road = RoadBounds{.left = 4.0, .right = -4.0})
      : profile_(StraightRoad(900.0, kSpeed), road, {}), planner_(kSettings, profile_) {}

  // A circle `ahead` of the vehicle's centre and `Y` left of the middle of the road [m].
  static Obstacle At(double ahead, double Y, double radius, PassingSide side = PassingSide::kUnknown) {
    return {.X = kPlace + ahead, .Y = Y, .r_x = radius, .r_y = radius, .side = side};
  }
  static Obstacle Car(double ahead, double Y, double speed) {
    return {.X = kPlace + ahead,
            .Y = Y,
            .r_x = 2.2,
            .r_y = 0.9,
            .velocity_X = speed,
            .shape = ObstacleShape::kBox,
            .object_class = ObstacleClass::kVehicle};
  }

  const Manoeuvre& Plan(std::vector<Obstacle> obstacles, double lateral = 0.0, double speed = kSpeed) {
    obstacles_ = std::move(obstacles);
    int id = 0;
    for (Obstacle& obstacle : obstacles_) obstacle.id = ++id;
    return planner_.Plan(obstacles_, {.s = kPlace, .lateral = lateral, .speed = speed});
  }
  const Manoeuvre& PlanAnew(std::vector<Obstacle> obstacles, double lateral = 0.0, double speed = kSpeed) {
    planner_.Reset();
    return Plan(std::move(obstacles), lateral, speed);
  }
  Decision Decide(const std::vector<Obstacle>& obstacles, double lateral = 0.0, double speed = kSpeed) {
    return PlanAnew(obstacles, lateral, speed).decision;
  }
  // Moves the vehicle by a step as planned: on its path, as fast as limits and stop lines allow.
  static void Drive(const Manoeuvre& manoeuvre, RoadPosition& vehicle) {
    const double wanted = std::min({kSpeed, manoeuvre.SpeedLimitAt(vehicle.s),
                                    SpeedBefore(manoeuvre.stops(), vehicle.s, 0.0, 2.0, 4.0)});
    vehicle.speed = std::clamp(wanted, vehicle.speed - 5.0 * kStep, vehicle.speed + 1.5 * kStep);
    vehicle.s += vehicle.speed * kStep;
    vehicle.lateral = manoeuvre.path.At(vehicle.s).offset;
    vehicle.slope = manoeuvre.path.At(vehicle.s).slope;
  }
  // On which the first obstacle is passed.
  Side SideOf(const Obstacle& obstacle, double lateral = 0.0) {
    const Manoeuvre& manoeuvre = PlanAnew({obstacle}, lateral);
    EXPECT_EQ(manoeuvre.decision, Decision::kPass);
    return manoeuvre.side[0];
  }

  RoadProfile profile_;
  TrafficPlanner planner_;
  std::vector<Obstacle> obstacles_;
};

}  // namespace control::testing
