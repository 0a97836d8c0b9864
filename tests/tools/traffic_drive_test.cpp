// What the controller decides about other things on the road, in closed loop over the bus: drives of the catalogue, made
// harder where its scenario is the mildest of its kind.
#include <filesystem>
#include <gtest/gtest.h>
#include <optional>
#include <string>

#include "bus/messages.hpp"
#include "loop/config.hpp"
#include "sim/scenario.hpp"
#include "tools/drive/closed_loop.hpp"
#include "tools/drive/scenario_config.hpp"

namespace {

class TrafficDrive : public testing::Test {
 protected:
  void Load(const std::string& name) {
    const std::filesystem::path file =
        std::filesystem::path(LPVMPC_SOURCE_DIR "/scenarios/catalogue") / name / "scenario.toml";
    scenario_.emplace(sim::LoadScenario(file));
    config_ = tools::LoadConfigFor(*scenario_, file, {});
  }
  sim::Scenario& scenario() { return *scenario_; }
  loop::Config& config() { return config_; }

  sim::Summary Drive(const tools::ClosedLoopHooks& hooks = {}) {
    return tools::DriveClosedLoop(*scenario_, config_, hooks);
  }

 private:
  std::optional<sim::Scenario> scenario_;
  loop::Config config_;
};

control::Obstacle ParkedCar(double X, double Y) {
  return {.id = 0,
          .X = X,
          .Y = Y,
          .r_x = 2.25,
          .r_y = 0.9,
          .shape = control::ObstacleShape::kBox,
          .object_class = control::ObstacleClass::kVehicle};
}

// The margins to both edges cannot be kept there; being through sooner is no way out.
TEST_F(TrafficDrive, NarrowStreetIsNotDrivenFasterThanItsTarget) {
  Load("050-narrow-street-2.6m");
  const sim::Summary summary = Drive();
  EXPECT_TRUE(summary.completed);
  EXPECT_GT(summary.min_road_margin_m.value_or(-1.0), 0.0);
  EXPECT_LT(summary.max_speed_excess_mps.value_or(1e9), 0.2);
}

TEST_F(TrafficDrive, LaneOfRoadworksIsDrivenWithCalmSteering) {
  Load("051-roadworks-2.5m");
  const sim::Summary summary = Drive();
  EXPECT_TRUE(summary.completed);
  EXPECT_GT(summary.min_road_margin_m.value_or(-1.0), 0.0);
  EXPECT_LT(summary.rms_steering_rate.value_or(1e9), 0.05);
  EXPECT_LT(summary.p99_steering_rate.value_or(1e9), 0.2);
}

TEST_F(TrafficDrive, FromCloseBehindAParkedCarItCreepsOut) {
  Load("035-start-behind-parked");
  const double front = scenario().initial[control::kX] + scenario().footprint.front;
  scenario().obstacles = {ParkedCar(front + 3.5 + 2.25, -0.6)};
  const sim::Summary summary = Drive();
  EXPECT_TRUE(summary.completed);
  EXPECT_GT(summary.min_clearance_m.value_or(-1.0), 0.0);
  EXPECT_LT(summary.longest_free_standstill_s, 3.0);
  EXPECT_EQ(summary.safe_stops, 0);
}

// At standstill the model says that steering has no effect.
TEST_F(TrafficDrive, WheelsTurnedToTheirStopAreNoReasonToStand) {
  for (const double delta : {0.5, -0.5}) {
    Load("035-start-behind-parked");
    scenario().initial_delta = delta;
    const sim::Summary summary = Drive();
    EXPECT_TRUE(summary.completed) << delta;
    EXPECT_GT(summary.min_clearance_m.value_or(-1.0), 0.0) << delta;
    EXPECT_LT(summary.longest_free_standstill_s, 3.0) << delta;
    EXPECT_EQ(summary.safe_stops, 0) << delta;
  }
}

// What the first steps of a plan do is decided by the commands before it, so that they are no reason to refuse it.
TEST_F(TrafficDrive, SteeringBeforeTheFirstPlanIsNoReasonToRefuseItOnSnow) {
  Load("080-snow-told");
  scenario().initial[control::kOmega] = 0.3;
  scenario().initial[control::kNu] = 0.3;
  const sim::Summary summary = Drive();
  EXPECT_TRUE(summary.completed);
  EXPECT_EQ(summary.rejected_plans, 0);
  EXPECT_EQ(summary.safe_stops, 0);
  EXPECT_GT(summary.min_clearance_m.value_or(-1.0), 0.0);
}

TEST_F(TrafficDrive, ParkedCarIsPassedThoughTheRoadGivesHalfTheGripThatIsTold) {
  Load("081-snow-untold");
  scenario().plant.mu = 0.35;
  config().affine.mu = 0.7;
  scenario().obstacles = {ParkedCar(45.0, -1.5)};
  const sim::Summary summary = Drive();
  EXPECT_TRUE(summary.completed);
  EXPECT_GT(summary.min_clearance_m.value_or(-1.0), 0.0);
  EXPECT_GT(summary.min_road_margin_m.value_or(-1.0), 0.0);
  EXPECT_EQ(summary.safe_stops, 0);
}

TEST_F(TrafficDrive, WaitingBeforeTheLineAfterTheFirstLapIsNotTheRoutesEnd) {
  Load("044-two-laps");
  const control::RoutePoint line = scenario().route.At(0.5 * scenario().route.length());
  control::Obstacle blocks = ParkedCar(line.X + 5.0, line.Y);
  blocks.r_x = 1.0;
  blocks.r_y = 3.5;
  scenario().obstacles = {blocks};
  scenario().appears_at = {{0, 15.0}};
  scenario().disappears_at = {{0, 50.0}};
  scenario().duration = 130.0;
  double stood = 0.0;
  bool active = true;
  double now = 0.0;
  const sim::Summary summary =
      Drive({.cycle = [&](const tools::CycleTimes&, const loop::CycleReport& report) {
        now += sim::kCycleTime;
        if (now < 5.0 || now > 60.0) return;
        active = active && report.mode == bus::Mode::kActive;
        if (report.manoeuvre.decision == bus::ManoeuvreDecision::kWait) stood += sim::kCycleTime;
      }});
  EXPECT_TRUE(active);
  EXPECT_GT(stood, 5.0);
  EXPECT_TRUE(summary.completed);
  EXPECT_GT(summary.min_clearance_m.value_or(-1.0), 0.0);
  EXPECT_FALSE(summary.time_is_up);
}

}  // namespace
