#include "tools/drive/closed_loop.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "control/road/projection.hpp"

namespace {

const std::filesystem::path kDemo = LPVMPC_SOURCE_DIR "/scenarios/demo";

struct Drive {
  sim::Summary summary;
  std::vector<can::Frame> frames;
};

Drive DriveDemo(const std::string& controller = "lpv") {
  loop::Config config = loop::LoadConfig(kDemo / "lpvmpcd.toml");
  loop::SelectController(config, controller);
  Drive drive;
  drive.summary =
      tools::DriveClosedLoop(sim::LoadScenario(kDemo / "scenario.toml"), config,
                             {.frame = [&](const can::Frame& frame) { drive.frames.push_back(frame); }});
  return drive;
}

TEST(ClosedLoop, TrustRegionDrivesTheDemoClearOfObstaclesAndInsideTheRoad) {
  const sim::Summary summary = DriveDemo().summary;
  EXPECT_TRUE(summary.completed);
  EXPECT_EQ(summary.infeasible_steps, 0);
  EXPECT_GE(summary.min_clearance_m.value_or(-1.0), 0.0);
  EXPECT_GE(summary.min_road_margin_m.value_or(-1.0), 0.0);
  EXPECT_LT(summary.rms_lateral_error_m.value_or(1e9), 0.5);
}

TEST(ClosedLoop, RoadThatNarrowsIsDrivenAtSpeedAndInsideItsEdges) {
  const std::filesystem::path folder = LPVMPC_SOURCE_DIR "/scenarios/narrowing_road";
  const sim::Scenario scenario = sim::LoadScenario(folder / "scenario.toml");
  const sim::Summary summary = tools::DriveClosedLoop(scenario, loop::LoadConfig(folder / "lpvmpcd.toml"));
  EXPECT_TRUE(summary.passed());
  EXPECT_EQ(summary.rejected_plans, 0);
  EXPECT_GT(summary.min_road_margin_m.value_or(-1.0), 0.0);
  EXPECT_LT(static_cast<double>(summary.steps) * sim::kCycleTime, 1.25 * scenario.route.duration());
}

TEST(ClosedLoop, StandardLpvmpcBecomesInfeasibleInTheSameScenario) {
  EXPECT_GT(DriveDemo("lpv-standard").summary.infeasible_steps, 0);
}

TEST(ClosedLoop, NmpcDrivesByTheSameFrames) {
  sim::Scenario scenario = sim::LoadScenario(kDemo / "scenario.toml");
  scenario.duration = 10.0;
  loop::Config config = loop::LoadConfig(kDemo / "lpvmpcd.toml");
  loop::SelectController(config, "nmpc");
  int steps = 0, solved = 0;
  const sim::Summary summary = tools::DriveClosedLoop(
      scenario, config, {.step = [&](const tools::StepObservation& observed) {
        ++steps;
        solved += static_cast<int>(observed.plan.status == control::SolverStatus::kSolved);
        EXPECT_GT(observed.seconds, 0.0);
      }});
  EXPECT_TRUE(summary.completed);
  EXPECT_EQ(summary.infeasible_steps, 0);
  EXPECT_LT(summary.rms_lateral_error_m.value_or(1e9), 0.1);
  EXPECT_GT(steps, 150);
  EXPECT_EQ(solved, steps);
}

TEST(ClosedLoop, LorryAtAnAngleIsPassedWithoutTouchingItsCorners) {
  const std::filesystem::path folder = LPVMPC_SOURCE_DIR "/scenarios/whole_drive";
  sim::Scenario scenario = sim::LoadScenario(folder / "scenario.toml");
  const control::RoutePoint at = scenario.route.At(150.0);
  const Eigen::Vector2d centre = control::Beside(at, -2.4);
  scenario.obstacles = {{.id = 40,
                         .X = centre.x(),
                         .Y = centre.y(),
                         .r_x = 8.0,
                         .r_y = 1.25,
                         .heading = control::WrapAngle(at.psi + 0.12),
                         .shape = control::ObstacleShape::kBox,
                         .object_class = control::ObstacleClass::kVehicle}};
  scenario.appears_at.clear();
  scenario.duration = 35.0;
  const loop::Config config = loop::LoadConfig(folder / "lpvmpcd.toml");
  double farthest = 0.0;
  const sim::Summary summary = tools::DriveClosedLoop(
      scenario, config, {.step = [&](const tools::StepObservation& observed) {
        farthest = std::max(farthest, scenario.route.Project(observed.plan.z[0].head<2>()).s);
      }});
  EXPECT_GT(farthest, 200.0) << "the lorry is not passed";
  EXPECT_EQ(summary.infeasible_steps, 0);
  EXPECT_GT(summary.min_clearance_m.value_or(-1.0), 0.1);
  EXPECT_LT(summary.min_clearance_m.value_or(1e9), 1.0);
  EXPECT_GE(summary.min_road_margin_m.value_or(-1.0), 0.0);
}

TEST(ClosedLoop, StopEndsTheDriveThere) {
  int cycles = 0;
  const sim::Summary summary = tools::DriveClosedLoop(sim::LoadScenario(kDemo / "scenario.toml"),
                                                      loop::LoadConfig(kDemo / "lpvmpcd.toml"),
                                                      {.stop = [&] { return ++cycles == 50; }});
  EXPECT_LE(summary.steps, 50);
  EXPECT_FALSE(summary.completed);
}

TEST(ClosedLoop, SameScenarioGivesTheSameFramesButForTheTimeThatSolvingTook) {
  const bus::VehicleBus bus;
  const std::uint32_t status = bus.Info<bus::ControllerStatus>().id;
  const Drive a = DriveDemo(), b = DriveDemo();
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    if (a.frames[i].id == status) continue;
    ASSERT_TRUE(can::SameOnWire(a.frames[i], b.frames[i])) << "frame " << i << " with id " << a.frames[i].id;
  }
}

TEST(ClosedLoop, NothingIsCommandedBeforeEngagement) {
  const bus::VehicleBus bus;
  bool engaged = false;
  int enabled = 0;
  for (const can::Frame& frame : DriveDemo().frames) {
    const auto message = bus.Decode(frame.id, frame.Payload());
    ASSERT_TRUE(message);
    if (const auto* request = std::get_if<bus::DriverRequest>(&*message))
      engaged = engaged || request->engage;
    if (const auto* steering = std::get_if<bus::SteeringCommand>(&*message)) {
      ASSERT_TRUE(engaged || !steering->enable);
      enabled += static_cast<int>(steering->enable);
    }
  }
  EXPECT_GT(enabled, 1000);
}

}  // namespace
