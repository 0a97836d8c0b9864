#include "sim/traffic.hpp"

#include <cmath>
#include <numbers>
#include <variant>

#include "control/road/keep_out.hpp"
#include "control/road/projection.hpp"
#include "gtest/gtest.h"
#include "sim/follower.hpp"
#include "tests/sim/drive_test.hpp"

namespace sim {
namespace {

const std::string kSize = "[[obstacle]]\nid = 1\nr_x = 2.3\nr_y = 0.9\n";
const std::string kAlong = kSize + "along_route = true\n";
const std::string kCar = "[vehicle]\nfront = 1.95\nrear = 2.3\nwidth = 1.8\n";

class TrafficTest : public testing::Test {
 protected:
  // The only object, `time` [s] after the start, if the vehicle stays where it is.
  static control::Obstacle After(const Scenario& scenario, double time) {
    Traffic traffic(scenario);
    if (time > 0.0) traffic.Advance(time, scenario.initial);
    return traffic.Now().at(0);
  }
  ScenarioFiles files_;
};

TEST_F(TrafficTest, ObjectWithoutAMotionKeepsItsVelocityToTheBit) {
  const Scenario scenario = files_.Load(kSize + "X = 20.1\nY = 0.3\nvelocity_X = 3.7\nvelocity_Y = -0.9\n");
  for (int cycle = 0; cycle < 100; ++cycle) {
    const double time = cycle * kCycleTime;
    const control::Obstacle now = After(scenario, time);
    const control::Obstacle expected = control::Predict(scenario.obstacles[0], time);
    EXPECT_EQ(now.X, expected.X);
    EXPECT_EQ(now.Y, expected.Y);
  }
}

TEST_F(TrafficTest, DistanceIsTheIntegralOfTheSpeedProfile) {
  const Scenario scenario =
      files_.Load(kAlong +
                  "s = 5\nspeed_profile = [{time = 1.0, speed = 4.0}, {time = 3.0, speed = 10.0}, "
                  "{time = 8.0, speed = 0.0}]\n");
  const auto s = [&](double time) { return StateAt(scenario.motions.at(1), time).s; };
  EXPECT_NEAR(s(0.0), 5.0, 1e-12);
  EXPECT_NEAR(s(1.0), 9.0, 1e-12);
  EXPECT_NEAR(s(2.0), 9.0 + 5.5, 1e-12);
  EXPECT_NEAR(s(3.0), 9.0 + 14.0, 1e-12);
  EXPECT_NEAR(s(8.0), 9.0 + 14.0 + 25.0, 1e-12);
  EXPECT_NEAR(s(20.0), 48.0, 1e-12);
  EXPECT_NEAR(StateAt(scenario.motions.at(1), 2.0).speed, 7.0, 1e-12);
  const control::Obstacle stopped = After(scenario, 9.0);
  EXPECT_NEAR(stopped.X, 10.0 + 48.0, 1e-9);
  EXPECT_EQ(stopped.velocity_X, 0.0);
}

TEST_F(TrafficTest, PositionIsTheIntegralOfTheVelocityInABendWhileItShifts) {
  const Scenario scenario =
      files_.Load(kAlong +
                  "s = 70\nspeed_profile = [{time = 1.0, speed = 12.0}, {time = 4.0, speed = 6.0}]\n"
                  "lateral_profile = [{time = 0.5, lateral = 3.0}, {time = 3.5, lateral = -1.0}]\n");
  constexpr double kStep = 1e-3;
  Eigen::Vector2d place(After(scenario, 0.0).X, After(scenario, 0.0).Y);
  for (double time = 0.0; time < 5.0; time += kStep) {
    const control::Obstacle middle = After(scenario, time + 0.5 * kStep);
    place += kStep * Eigen::Vector2d(middle.velocity_X, middle.velocity_Y);
  }
  const control::Obstacle last = After(scenario, 5.0);
  EXPECT_NEAR(place.x(), last.X, 1e-4);
  EXPECT_NEAR(place.y(), last.Y, 1e-4);
  // The heading is that of the velocity, which turns with the road and the drift.
  for (const double time : {0.2, 1.0, 2.0, 3.0, 4.5}) {
    const control::Obstacle now = After(scenario, time);
    EXPECT_NEAR(now.heading, std::atan2(now.velocity_Y, now.velocity_X), 1e-9) << time;
  }
  EXPECT_NEAR(StateAt(scenario.motions.at(1), 2.0).lateral, 1.0, 1e-12);  // half way
  EXPECT_EQ(StateAt(scenario.motions.at(1), 0.5).lateral, 3.0);
  EXPECT_NEAR(StateAt(scenario.motions.at(1), 0.5001).lateral_rate, 0.0, 1e-3);  // starts smoothly
}

TEST_F(TrafficTest, OncomingObjectFollowsTheRoadBackwards) {
  const Scenario scenario = files_.Load(kAlong + "s = 150\nlateral = 2\nheading = 3.14159265\nspeed = -8\n");
  for (const double time : {0.0, 3.0, 15.0}) {
    const control::Obstacle now = After(scenario, time);
    const control::RoutePoint point = scenario.route.At(150.0 - 8.0 * time);
    const Eigen::Vector2d centre = control::Beside(point, 2.0);
    EXPECT_NEAR(now.X, centre.x(), 1e-9);
    EXPECT_NEAR(now.Y, centre.y(), 1e-9);
    EXPECT_NEAR(control::WrapAngle(now.heading - point.psi - std::numbers::pi), 0.0, 1e-6);
    EXPECT_NEAR(std::hypot(now.velocity_X, now.velocity_Y), 8.0 * (1.0 - 2.0 * point.curvature), 1e-9);
    EXPECT_NEAR(std::atan2(now.velocity_Y, now.velocity_X), now.heading, 1e-6);
  }
  EXPECT_EQ(scenario.obstacles[0].X, After(scenario, 0.0).X);  // its start, for whoever asks the scenario
  EXPECT_EQ(scenario.obstacles[0].velocity_X, After(scenario, 0.0).velocity_X);
}

TEST_F(TrafficTest, PedestrianWhoOnlyCrossesKeepsTheHeading) {
  const Scenario scenario = files_.Load(kAlong +
                                        "s = 40\nheading = 1.5\nlateral_profile = [{time = 1.0, lateral = "
                                        "-3.0}, {time = 5.0, lateral = 3.0}]\n");
  const control::Obstacle crossing = After(scenario, 3.0);
  EXPECT_NEAR(crossing.heading, 1.5, 1e-12);
  EXPECT_NEAR(crossing.Y, 0.0, 1e-9);
  EXPECT_NEAR(crossing.velocity_Y, 0.5 * 6.0 * std::numbers::pi / 4.0, 1e-9);
}

TEST_F(TrafficTest, ObjectThatHasDisappearedIsGone) {
  const Scenario scenario = files_.Load(kSize + "s = 40\ndisappears_at = 2.0\n");
  Traffic traffic(scenario);
  traffic.Advance(1.95, scenario.initial);
  EXPECT_EQ(traffic.Now().size(), 1u);
  traffic.Advance(2.0, scenario.initial);
  EXPECT_TRUE(traffic.Now().empty());
}

TEST_F(TrafficTest, FramesCarryPlaceHeadingAndVelocityOfNow) {
  const Scenario scenario = files_.Load(kAlong + "s = 80\nlateral = 1\nspeed = 10\n");
  const bus::VehicleBus bus;
  VirtualVehicle vehicle(scenario, bus);
  for (int i = 0; i < 60; ++i) vehicle.Advance();
  const control::RoutePoint point = scenario.route.At(110.0);
  int seen = 0;
  for (const can::Frame& frame : vehicle.Sense({})) {
    const bus::Message message = bus.Decode(frame.id, frame.Payload()).value();
    if (const auto* position = std::get_if<bus::ObstaclePosition>(&message)) {
      EXPECT_NEAR(position->X, control::Beside(point, 1.0).x(), 1e-3);
      EXPECT_NEAR(position->Y, control::Beside(point, 1.0).y(), 1e-3);
      ++seen;
    } else if (const auto* shape = std::get_if<bus::ObstacleShape>(&message)) {
      EXPECT_NEAR(shape->heading, point.psi, 1e-3);
      EXPECT_GT(shape->heading, 0.2);
      ++seen;
    } else if (const auto* motion = std::get_if<bus::ObstacleMotion>(&message)) {
      const double speed = 10.0 * (1.0 - point.curvature);
      EXPECT_NEAR(motion->velocity_X, speed * std::cos(point.psi), 1e-2);
      EXPECT_NEAR(motion->velocity_Y, speed * std::sin(point.psi), 1e-2);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 3);
}

TEST(Follower, WantsItsSpeedOnAFreeRoadAndItsHeadwayBehindALeader) {
  EXPECT_NEAR(FollowerAcceleration(14.0, 14.0, {}), 0.0, 1e-12);
  EXPECT_NEAR(FollowerAcceleration(0.0, 14.0, {}), kFollowerAcceleration, 1e-12);
  EXPECT_LT(FollowerAcceleration(16.0, 14.0, {}), 0.0);
  // At half the desired speed behind a leader as fast, in equilibrium.
  const double gap = (kFollowerGap + 7.0 * kFollowerHeadway) / std::sqrt(1.0 - 1.0 / 16.0);
  EXPECT_NEAR(FollowerAcceleration(7.0, 14.0, Leader{.gap = gap, .speed = 7.0}), 0.0, 1e-12);
  EXPECT_EQ(FollowerAcceleration(14.0, 14.0, Leader{.gap = 1.0, .speed = 0.0}), -kHardestByFollower);
  EXPECT_EQ(FollowerAcceleration(14.0, 14.0, Leader{.gap = -1.0, .speed = 20.0}), -kHardestByFollower);
}

class FollowerTest : public DriveTest {
 protected:
  FollowerTest() {
    files_.Write("route.toml",
                 "[route]\nspeed = 12\nstart = {X = 10, Y = 0, psi = 0}\n"
                 "pieces = [{kind = \"straight\", length = 400}]\n[road]\nleft = 4\nright = 4\n");
  }
  static void Brake(FakeDaemon& controller, const VirtualVehicle& vehicle) {
    controller.acceleration = vehicle.time() > 2.0 ? -8.0 : 0.0;
  }
};

// 12 m behind the vehicle's rear.
const std::string kBehind = kAlong + "s = 23.4\nspeed = 12\n";
const std::string kStart = "duration = 12.0\n[initial]\nalong = 40\n";

TEST_F(FollowerTest, DoesNotRunIntoAVehicleThatBrakesHard) {
  const Summary summary = Drive(files_.Load(kStart + kBehind + "follows = true\n" + kCar), Brake);
  EXPECT_FALSE(summary.contact_step);
  EXPECT_GT(*summary.min_clearance_m, 0.5);
  EXPECT_LT(*summary.min_clearance_m, 4.0);  // it comes near
  // Without its driver, it would.
  const Summary blind = Drive(files_.Load(kStart + kBehind + kCar), Brake);
  EXPECT_TRUE(blind.contact_step);
  EXPECT_EQ(blind.contact_fault, ContactFault::kTheirs);
}

TEST_F(FollowerTest, DrivesOnWhenTheVehicleIsNotInItsWay) {
  const Scenario scenario = files_.Load(kStart + kBehind + "follows = true\nlateral = 2.5\n" + kCar);
  Traffic traffic(scenario);
  for (int cycle = 1; cycle <= 200; ++cycle) traffic.Advance(cycle * kCycleTime, scenario.initial);
  EXPECT_NEAR(traffic.Now()[0].X, 10.0 + 23.4 + 120.0, 1e-6);
}

TEST_F(FollowerTest, DoesNotMindAVehicleBehind) {
  const Scenario scenario =
      files_.Load("[initial]\nalong = 40\n" + kAlong + "s = 50\nspeed = 12\nfollows = true\n" + kCar);
  Traffic traffic(scenario);
  for (int cycle = 1; cycle <= 100; ++cycle) traffic.Advance(cycle * kCycleTime, scenario.initial);
  EXPECT_NEAR(traffic.Now()[0].X, 10.0 + 50.0 + 60.0, 1e-6);
}

TEST_F(FollowerTest, StopsBehindAStandingVehicleAndStays) {
  const Scenario scenario = files_.Load("[initial]\nalong = 120\nspeed = 0\n" + kAlong +
                                        "s = 20\nspeed = 12\nfollows = true\n" + kCar);
  Traffic traffic(scenario);
  double before = 0.0;
  for (int cycle = 1; cycle <= 800; ++cycle) {
    traffic.Advance(cycle * kCycleTime, scenario.initial);
    EXPECT_GE(traffic.Now()[0].X, before);
    before = traffic.Now()[0].X;
  }
  const double gap = (10.0 + 120.0 - 2.3) - (traffic.Now()[0].X + 2.3);
  EXPECT_NEAR(gap, kFollowerGap, 0.3);
}

TEST_F(FollowerTest, OncomingDriverStopsBeforeTheVehicleInItsLane) {
  const Scenario scenario = files_.Load("[initial]\nalong = 50\nspeed = 0\n" + kAlong +
                                        "s = 200\nspeed = -12\nheading = 3.14159\nfollows = true\n" + kCar);
  Traffic traffic(scenario);
  for (int cycle = 1; cycle <= 800; ++cycle) traffic.Advance(cycle * kCycleTime, scenario.initial);
  const double gap = (traffic.Now()[0].X - 2.3) - (10.0 + 50.0 + 1.95);
  EXPECT_NEAR(gap, kFollowerGap, 0.3);
}

}  // namespace
}  // namespace sim
