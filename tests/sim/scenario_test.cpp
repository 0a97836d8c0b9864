#include "sim/scenario.hpp"

#include <cmath>
#include <fmt/format.h>

#include "config/toml_table.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/sim/scenario_files.hpp"
#include "tests/support/header_example.hpp"

namespace sim {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class ScenarioTest : public testing::Test {
 protected:
  std::string ErrorOf(const std::string& text) const {
    try {
      (void)files_.Load(text);
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    return "no error";
  }
  ScenarioFiles files_;
};

const std::string kObstacle = "[[obstacle]]\nid = 1\nr_x = 1.0\nr_y = 0.5\n";

TEST_F(ScenarioTest, StartsOnTheRouteAtItsSpeedByDefault) {
  const Scenario scenario = files_.Load("");
  EXPECT_EQ(scenario.initial[control::kX], 10.0);
  EXPECT_EQ(scenario.initial[control::kUpsilon], 12.0);
  EXPECT_EQ(scenario.initial_delta, 0.0);
  EXPECT_TRUE(scenario.obstacles.empty());
  EXPECT_FALSE(scenario.duration);
  EXPECT_TRUE(scenario.expect.completed);
}

TEST_F(ScenarioTest, ExampleOfTheHeaderIsAScenario) {
  const std::string example = test_support::ExampleOf("sim/scenario.hpp");
  files_.Write("example.toml", example);
  const Scenario scenario = LoadScenario(files_.folder() / "example.toml");
  EXPECT_EQ(scenario.obstacles.size(), 5u);
  EXPECT_EQ(scenario.appears_at.at(1), 0.0);
  EXPECT_EQ(scenario.disappears_at.at(1), 40.0);
  EXPECT_EQ(scenario.motions.size(), 3u);
  EXPECT_EQ(scenario.motions.at(4).speed.size(), 2u);
  EXPECT_TRUE(scenario.motions.at(5).follows);
  EXPECT_EQ(scenario.expect.max_deadline_misses, 0);
  EXPECT_EQ(scenario.expect.max_rms_lateral_error_m, 0.5);
  EXPECT_EQ(scenario.expect.max_speed_excess_mps, 0.5);
  EXPECT_EQ(scenario.expect.max_rms_steering_rate, 0.2);
  EXPECT_EQ(scenario.expect.max_p99_steering_rate, 0.5);
  EXPECT_EQ(scenario.expect.max_rms_jerk, 2.0);
  EXPECT_EQ(scenario.expect.max_p99_jerk, 8.0);
  EXPECT_EQ(scenario.expect.max_free_standstill_s, 3.0);
  EXPECT_EQ(scenario.expect.max_end_overshoot_m, 0.3);
  EXPECT_EQ(scenario.expect.max_end_gap_m, 0.3);
  EXPECT_EQ(scenario.expect.max_mode_changes, 0);
  EXPECT_EQ(scenario.expect.max_safe_stops, 0);
  EXPECT_EQ(scenario.expect.min_time_to_collision_s, 1.0);
}

TEST_F(ScenarioTest, StartInACurveIsSteadyCornering) {
  const Scenario scenario = files_.Load("[initial]\nalong = 120.0\n");
  Plant plant(scenario.plant, scenario.initial);
  const control::Input u(scenario.initial_delta, 0.0);
  for (int i = 0; i < 1000; ++i) plant.Step(u, u, u, 1e-3);
  EXPECT_NEAR(plant.state()[control::kOmega], scenario.initial[control::kOmega], 2e-3);
  const control::RouteProjection place =
      scenario.route.Project({plant.state()[control::kX], plant.state()[control::kY]});
  EXPECT_NEAR(place.lateral, 0.0, 0.02);
}

TEST_F(ScenarioTest, InitialOffsetsAreRelativeToTheRoute) {
  const Scenario scenario = files_.Load("[initial]\nalong = 20\nlateral = -0.5\nheading = 0.1\nspeed = 8\n");
  EXPECT_NEAR(scenario.initial[control::kX], 30.0, 1e-12);
  EXPECT_NEAR(scenario.initial[control::kY], -0.5, 1e-12);
  EXPECT_NEAR(scenario.initial[control::kPsi], 0.1, 1e-12);
  EXPECT_EQ(scenario.initial[control::kUpsilon], 8.0);
}

TEST_F(ScenarioTest, ObstacleIsPlacedInTheMapOrAlongTheRoute) {
  const Scenario scenario =
      files_.Load(kObstacle + "X = 50\nY = -1\nheading = 0.3\nside = \"left\"\n" +
                  "[[obstacle]]\nid = 2\nr_x = 1\nr_y = 1\ns = 120\nlateral = 2\nheading = 0.1\n");
  ASSERT_EQ(scenario.obstacles.size(), 2u);
  EXPECT_EQ(scenario.obstacles[0].X, 50.0);
  EXPECT_EQ(scenario.obstacles[0].heading, 0.3);
  EXPECT_EQ(scenario.obstacles[0].side, control::PassingSide::kLeft);
  EXPECT_EQ(scenario.obstacles[1].side, control::PassingSide::kUnknown);
  const control::RouteProjection place =
      scenario.route.Project({scenario.obstacles[1].X, scenario.obstacles[1].Y});
  EXPECT_NEAR(place.s, 120.0, 1e-6);
  EXPECT_NEAR(place.lateral, 2.0, 1e-9);
  EXPECT_NEAR(scenario.obstacles[1].heading, scenario.route.At(120.0).psi + 0.1, 1e-12);
}

TEST_F(ScenarioTest, ObstacleHasAShapeAndAClass) {
  const Scenario scenario = files_.Load(
      "[[obstacle]]\nid = 63\nr_x = 20\nr_y = 1.25\ns = 50\nshape = \"box\"\nclass = \"vehicle\"\n" +
      kObstacle + "s = 120\n");
  ASSERT_EQ(scenario.obstacles.size(), 2u);
  EXPECT_EQ(scenario.obstacles[0].id, 63);
  EXPECT_EQ(scenario.obstacles[0].r_x, 20.0);
  EXPECT_EQ(scenario.obstacles[0].shape, control::ObstacleShape::kBox);
  EXPECT_EQ(scenario.obstacles[0].object_class, control::ObstacleClass::kVehicle);
  EXPECT_EQ(scenario.obstacles[1].shape, control::ObstacleShape::kEllipse);
  EXPECT_EQ(scenario.obstacles[1].object_class, control::ObstacleClass::kUnknown);
  EXPECT_THAT(ErrorOf(kObstacle + "s = 50\nshape = \"circle\"\n"),
              HasSubstr("must be one of \"ellipse\", \"box\""));
  EXPECT_THAT(ErrorOf(kObstacle + "s = 50\nclass = \"dog\"\n"),
              HasSubstr("must be one of \"unknown\", \"static\", \"vehicle\", \"cycle\", \"pedestrian\""));
  EXPECT_THAT(ErrorOf("[[obstacle]]\nid = 64\nr_x = 1\nr_y = 1\ns = 50\n"),
              EndsWith("'obstacle[0].id' = 64 is outside [0, 63]"));
  EXPECT_THAT(ErrorOf("[[obstacle]]\nid = 1\nr_x = 20.1\nr_y = 1\ns = 50\n"),
              EndsWith("'obstacle[0].r_x' = 20.1 is outside [0.05, 20] m"));
}

TEST_F(ScenarioTest, AsManyObstaclesAsTheBusHasIdsAreTaken) {
  std::string text;
  for (int id = 0; id < 64; ++id)
    text += fmt::format("[[obstacle]]\nid = {}\nr_x = 1\nr_y = 1\ns = {}\n", id, id);
  EXPECT_EQ(files_.Load(text).obstacles.size(), 64u);
}

TEST_F(ScenarioTest, DeviationsScaleTheVehicle) {
  const Scenario scenario = files_.Load(
      "[vehicle]\nmass_factor = 1.2\nfront_stiffness_factor = 0.9\ntyre = \"saturating\"\nmu = 0.6\n"
      "steering_lag = 0.06\nsteering_rate = 0.7\ndelay_cycles = 1\n");
  EXPECT_NEAR(scenario.plant.vehicle.m, 1.2 * 1919.0, 1e-9);
  EXPECT_NEAR(scenario.plant.vehicle.C_alpha_f, 0.9 * 156e3, 1e-9);
  EXPECT_EQ(scenario.plant.tyre, Tyre::kSaturating);
  EXPECT_EQ(scenario.plant.mu, 0.6);
  EXPECT_EQ(scenario.steering.time_constant, 0.06);
  EXPECT_EQ(scenario.steering.rate, 0.7);
  EXPECT_EQ(scenario.acceleration.delay_cycles, 1);
}

TEST_F(ScenarioTest, DisturbancesAreGivenWithTheVehicle) {
  const PlantParameters plant = files_
                                    .Load(
                                        "[vehicle]\nsteering_offset = 0.0175\nbank = -0.06\nslope = 0.05\n"
                                        "wind = {from = 2, until = 4, lateral_acceleration = -1.5}\n")
                                    .plant;
  EXPECT_EQ(plant.steering_offset, 0.0175);
  EXPECT_EQ(plant.bank, -0.06);
  EXPECT_EQ(plant.slope, 0.05);
  EXPECT_EQ(plant.wind.from, 2.0);
  EXPECT_EQ(plant.wind.until, 4.0);
  EXPECT_EQ(plant.wind.lateral_acceleration, -1.5);
  EXPECT_EQ(files_.Load("").plant.wind.lateral_acceleration, 0.0);
}

TEST_F(ScenarioTest, VehicleIsAPointUnlessItsRectangleIsGiven) {
  const Scenario point = files_.Load("");
  for (const Eigen::Vector2d& corner : point.footprint.Corners())
    EXPECT_EQ(corner, Eigen::Vector2d(0.0, 0.0));
  const Scenario car = files_.Load("[vehicle]\nfront = 1.95\nrear = 2.3\nwidth = 1.8\n");
  EXPECT_EQ(car.footprint.front, 1.95);
  EXPECT_EQ(car.footprint.rear, 2.3);
  EXPECT_EQ(car.footprint.half_width, 0.9);
  EXPECT_THAT(ErrorOf("[vehicle]\nwidth = -1.8\n"), EndsWith("'vehicle.width' = -1.8 is outside [0, 10] m"));
  EXPECT_THAT(ErrorOf("[vehicle]\nrear = 30\n"), EndsWith("'vehicle.rear' = 30 is outside [0, 20] m"));
}

TEST_F(ScenarioTest, ObstacleIsPerceivedFromTheStartUnlessItAppearsLater) {
  const Scenario scenario =
      files_.Load(kObstacle + "s = 50\nappears_at = 2.5\n[[obstacle]]\nid = 2\nr_x = 1\nr_y = 1\ns = 90\n");
  EXPECT_EQ(scenario.appears_at, (std::map<int, double>{{1, 2.5}}));
  EXPECT_THAT(ErrorOf(kObstacle + "s = 50\nappears_at = -1\n"),
              HasSubstr("key 'obstacle[0].appears_at' = -1 is outside [0, "));
}

TEST_F(ScenarioTest, ObstacleOutsideTheMapIsRefused) {
  EXPECT_EQ(
      ErrorOf(kObstacle + "X = 1700\nY = 0\n"),
      (files_.folder() / "scenario.toml:7: key 'obstacle[0].X' = 1700 is outside [-1, 1500] m").string());
  EXPECT_THAT(ErrorOf(kObstacle + "X = 1\nY = -600.5\n"),
              EndsWith(":8: key 'obstacle[0].Y' = -600.5 is outside [-600, 800] m"));
  files_.Write("route.toml",
               "[route]\nspeed = 12\nstart = {X = -100, Y = 0, psi = 0}\npieces = [{kind = \"straight\", "
               "length = 200}]\n"
               "[road]\nleft = 4\nright = 4\n");
  EXPECT_THAT(ErrorOf(kObstacle + "s = 20\n"),
              EndsWith(":7: key 'obstacle[0].s' = 20 puts the obstacle at X = -80.0, outside [-1, 1500] m"));
}

TEST_F(ScenarioTest, WrongInputNamesFileLineKeyAndValue) {
  EXPECT_THAT(ErrorOf("duration = \"long\"\n"),
              EndsWith(":3: key 'duration' = \"long\" (string) must be a number"));
  EXPECT_THAT(ErrorOf(kObstacle + "s = 500\n"), HasSubstr("'obstacle[0].s' = 500 is outside [0, 160"));
  EXPECT_THAT(ErrorOf(kObstacle), HasSubstr("key 'obstacle[0].X' is missing"));
  EXPECT_THAT(ErrorOf(kObstacle + "s = 5\nX = 3\n"),
              HasSubstr("key 'obstacle[0].X' = 3 must not be given along with s"));
  EXPECT_THAT(ErrorOf(kObstacle + "X = 5\nY = 3\nlateral = 1\n"), HasSubstr("must not be given without s"));
  EXPECT_THAT(ErrorOf(kObstacle + "s = 5\n" + kObstacle + "s = 50\n"),
              EndsWith(":9: key 'obstacle[1].id' = 1 is already used by another obstacle"));
  EXPECT_THAT(ErrorOf("[vehicle]\ntyre = \"round\"\n"),
              HasSubstr("must be one of \"linear\", \"saturating\""));
  EXPECT_THAT(ErrorOf("[expect]\nmin_clearence_m = 0\n"), EndsWith("is 'expect.min_clearance_m' meant?"));
}

TEST_F(ScenarioTest, WrongMotionOfAnObstacleIsRefused) {
  const std::string along = kObstacle + "s = 50\nalong_route = true\n";
  const auto expect = [this](const std::string& text, const std::string& error) {
    EXPECT_THAT(ErrorOf(text), HasSubstr("key 'obstacle[0]." + error)) << text;
  };
  expect(kObstacle + "X = 5\nY = 3\nalong_route = true\n", "along_route' = true must not be true without s");
  expect(kObstacle + "s = 50\nspeed = 3\n", "speed' = 3 must not be given without along_route = true");
  expect(kObstacle + "s = 50\nfollows = true\n",
         "follows' = true must not be given without along_route = true");
  for (const char* key : {"speed_profile", "lateral_profile"}) {
    expect(kObstacle + "s = 50\n" + key + " = [{time = 1}]\n", std::string(key) + "'");
    expect(along + key + " = []\n", std::string(key) + "'");
    EXPECT_THAT(ErrorOf(along + key + " = []\n"), EndsWith("must have at least one point"));
  }
  expect(along + "velocity_X = 1\n", "velocity_X' = 1 must not be given along with along_route");
  expect(along + "velocity_Y = 1\n", "velocity_Y' = 1 must not be given along with along_route");
  expect(along + "speed = 61\n", "speed' = 61 is outside [-60, 60] m/s");
  expect(along + "speed = 1\nspeed_profile = [{time = 1, speed = 2}]\n",
         "speed' = 1 must not be given along with speed_profile");
  expect(along + "lateral = 1\nlateral_profile = [{time = 1, lateral = 2}]\n",
         "lateral' = 1 must not be given along with lateral_profile");
  expect(along + "speed_profile = [{time = 1, speed = 2}, {time = 1, speed = 3}]\n",
         "speed_profile[1].time' = 1 must be later than that of the point before");
  expect(along + "speed_profile = [{time = -1, speed = 2}]\n", "speed_profile[0].time' = -1 is outside [0, ");
  expect(along + "lateral_profile = [{time = 1}]\n", "lateral_profile[0].lateral' is missing");
  expect(along + "follows = true\n", "speed' is missing");
  expect(along + "follows = true\nspeed = 0\n", "speed' = 0 must not be 0 along with follows");
  expect(along + "follows = true\nspeed = 1\nspeed_profile = [{time = 1, speed = 2}]\n", "speed_profile' ");
  expect(kObstacle + "s = 50\nappears_at = 3\ndisappears_at = 3\n",
         "disappears_at' = 3 must be later than 3 s, when it appears");
  EXPECT_THAT(ErrorOf(along + "speed_profile = [{time = 1, speed = 2, place = 3}]\n"),
              HasSubstr("unknown key 'obstacle[0].speed_profile[0].place'"));
  EXPECT_EQ(ErrorOf(along + "speed = -10\nlateral_profile = [{time = 1, lateral = 2}]\n"), "no error");
}

TEST_F(ScenarioTest, WrongExpectationIsRefused) {
  for (const char* key : {"max_speed_excess_mps", "max_rms_steering_rate", "max_p99_steering_rate",
                          "max_rms_jerk", "max_p99_jerk", "max_free_standstill_s", "max_end_overshoot_m",
                          "max_end_gap_m", "max_mode_changes", "max_safe_stops", "min_time_to_collision_s"}) {
    EXPECT_THAT(ErrorOf("[expect]\n" + std::string(key) + " = -1\n"),
                HasSubstr(":4: key 'expect." + std::string(key) + "' = -1 is outside [0, "));
  }
}

TEST_F(ScenarioTest, MissingRouteFileIsNamed) {
  files_.Write("other.toml", "name = \"a\"\nroute = \"none.toml\"\n");
  try {
    (void)LoadScenario(files_.folder() / "other.toml");
    FAIL();
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none.toml: cannot be read: No such file or directory"));
  }
}

TEST(ShippedScenario, DemoIsAMinuteOfCurvesInsideTheMap) {
  const Scenario scenario =
      LoadScenario(std::filesystem::path(LPVMPC_SOURCE_DIR) / "scenarios/demo/scenario.toml");
  EXPECT_NEAR(scenario.route.duration(), 60.0, 5.0);
  double sharpest_left = 0.0;
  double sharpest_right = 0.0;
  for (double s = 0.0; s <= scenario.route.length(); s += 1.0) {
    const control::RoutePoint point = scenario.route.At(s);
    EXPECT_GE(point.X, kMapMinX);
    EXPECT_LE(point.X, kMapMaxX);
    EXPECT_GE(point.Y, kMapMinY);
    EXPECT_LE(point.Y, kMapMaxY);
    sharpest_left = std::max(sharpest_left, point.curvature);
    sharpest_right = std::min(sharpest_right, point.curvature);
  }
  EXPECT_GT(sharpest_left, 0.005);
  EXPECT_LT(sharpest_right, -0.005);
  EXPECT_LE(std::max(sharpest_left, -sharpest_right), 1.0 / 80.0);
  EXPECT_FALSE(scenario.obstacles.empty());
}

}  // namespace
}  // namespace sim
