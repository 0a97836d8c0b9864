#include "sim/summary.hpp"

#include <nlohmann/json.hpp>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/sim/drive_test.hpp"

namespace sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using SummaryTest = DriveTest;

TEST_F(SummaryTest, DriveToTheEndOfTheRouteIsCompleted) {
  const Summary summary = Drive("[expect]\nmin_road_margin_m = 2.0\nmax_rms_lateral_error_m = 0.5\n");
  EXPECT_TRUE(summary.completed);
  EXPECT_FALSE(summary.standing);
  EXPECT_TRUE(summary.passed());
  EXPECT_EQ(summary.infeasible_steps, 0);
  EXPECT_NEAR(static_cast<double>(summary.steps) * kCycleTime, 160.0 / 12.0, 1.0);
  EXPECT_FALSE(summary.min_clearance_m);
  EXPECT_LT(*summary.rms_lateral_error_m, 0.5);
  EXPECT_GT(summary.solve_time_median_us, 0);
  EXPECT_LE(summary.solve_time_median_us, summary.solve_time_p99_us);
  EXPECT_LE(summary.solve_time_p99_us, summary.solve_time_max_us);
  EXPECT_EQ(summary.solve_time_max_us, 100);
}

TEST_F(SummaryTest, DurationEndsTheDrive) {
  const Summary summary = Drive("duration = 4.0\n");
  EXPECT_TRUE(summary.completed);
  EXPECT_LE(summary.steps, 80);
}

TEST_F(SummaryTest, SameScenarioGivesTheSameSummary) {
  const std::string noisy =
      "seed = 5\n[sensors]\nposition = 0.05\nspeed = 0.05\nheading = 0.004\nyaw_rate = 0.01\n";
  EXPECT_EQ(ToJson(Drive(noisy)), ToJson(Drive(noisy)));
}

TEST_F(SummaryTest, ClearanceIsTheDistanceToTheEdgeOfTheNearestObstacle) {
  const Summary summary = Drive(
      "duration = 6.0\n[[obstacle]]\nid = 1\nX = 50\nY = 2\nr_x = 3\nr_y = 0.5\n"
      "[[obstacle]]\nid = 2\nX = 60\nY = -3\nr_x = 1\nr_y = 1\n[expect]\nmin_clearance_m = 1.6\n");
  ASSERT_TRUE(summary.min_clearance_m);
  EXPECT_NEAR(*summary.min_clearance_m, 1.5, 0.02);  // the minimum is between two samples
  ASSERT_EQ(summary.failed_expectations.size(), 1u);
  EXPECT_THAT(summary.failed_expectations[0], HasSubstr("min_clearance_m = 1."));
}

const std::string kCar = "[vehicle]\nfront = 1.95\nrear = 2.3\nwidth = 1.8\n";

TEST_F(SummaryTest, ClearanceAndRoadMarginAreThoseOfTheFootprint) {
  const std::string drive =
      "duration = 4.5\n[[obstacle]]\nid = 1\nX = 50\nY = 3\nr_x = 1\nr_y = 0.5\nappears_at = 100\n";
  const Summary point = Drive(drive), car = Drive(drive + kCar);
  EXPECT_NEAR(*point.min_clearance_m, 2.5, 0.02);
  EXPECT_NEAR(*car.min_clearance_m, 2.5 - 0.9, 1e-3);
  EXPECT_NEAR(*point.min_road_margin_m, 3.0, 1e-3);
  EXPECT_NEAR(*car.min_road_margin_m, 3.0 - 0.9, 1e-3);
  EXPECT_FALSE(car.contact_step);
  EXPECT_FALSE(car.off_road_step);
}

TEST_F(SummaryTest, CornersLeaveTheRoadBeforeTheCentreDoes) {
  const std::string at_the_edge = "duration = 1.0\n[initial]\nlateral = -2.4\nheading = -0.05\n";
  EXPECT_GT(*Drive(at_the_edge).min_road_margin_m, 0.0);
  const Summary car = Drive(at_the_edge + kCar);
  EXPECT_LT(*car.min_road_margin_m, -0.35);
  EXPECT_EQ(car.off_road_step, 0);
}

TEST_F(SummaryTest, RoadMarginIsThatToTheEdgesBesideEachCorner) {
  // The left edge comes nearer by 0.125 m per metre from s = 30 m to 50 m.
  files_.Write("route.toml",
               "[route]\nstart = {X = 10.0, Y = 0.0, psi = 0.0}\nspeed = 12.0\npieces = [\n"
               "  {kind = \"straight\", length = 30.0},\n"
               "  {kind = \"straight\", length = 20.0, left = 1.5},\n"
               "  {kind = \"straight\", length = 60.0},\n"
               "]\n[road]\nleft = 4.0\nright = 4.0\n");
  // After 3 s at 12 m/s the front is at s = 37.95 m, less the way of one cycle.
  EXPECT_NEAR(*Drive("duration = 3.0\n" + kCar).min_road_margin_m, 4.0 - 0.125 * (37.95 - 30.0) - 0.9, 0.08);
  EXPECT_NEAR(*Drive(kCar).min_road_margin_m, 1.5 - 0.9, 1e-3);
}

TEST_F(SummaryTest, ContactIsReportedWithItsFirstStep) {
  // The obstacle's near edge is 38.9 m ahead of the centre of gravity, 36.95 m ahead of the front end.
  const std::string drive = "duration = 6.0\n[[obstacle]]\nid = 1\nX = 49.9\nY = 0\nr_x = 1\nr_y = 1\n";
  const Summary point = Drive(drive), car = Drive(drive + kCar);
  ASSERT_TRUE(point.contact_step && car.contact_step);
  // 1.95 m at 12 m/s take 3.25 cycles.
  EXPECT_NEAR(static_cast<double>(*point.contact_step - *car.contact_step), 3.25, 1.0);
  // Engagement takes some cycles.
  EXPECT_NEAR(static_cast<double>(*car.contact_step), 36.95 / 0.6, 8.0);
  EXPECT_LT(*car.min_clearance_m, -0.5);
  EXPECT_FALSE(car.off_road_step);
}

TEST_F(SummaryTest, DriveThatTheDriverEndedIsNotCompleted) {
  const Summary summary = Drive("duration = 6.0\n[driver]\ndisengage_at = 3.0\n");
  EXPECT_FALSE(summary.completed);
  EXPECT_THAT(summary.failed_expectations, ElementsAre("completed = false"));
}

TEST_F(SummaryTest, DriveThatComesToRestEnds) {
  const Summary summary = Drive("[driver]\nbrake_at = 2.0\n[expect]\ncompleted = false\n");
  EXPECT_FALSE(summary.completed);
  EXPECT_TRUE(summary.standing);
  EXPECT_TRUE(summary.passed());
}

TEST_F(SummaryTest, ControllerThatNeverEngagesGivesNoSteps) {
  const Summary summary = Drive(files_.Load("duration = 2.0\n"), [](FakeDaemon& controller, VirtualVehicle&) {
    controller.mode = bus::Mode::kInit;
  });
  EXPECT_FALSE(summary.completed);
  EXPECT_EQ(summary.steps, 0);
  EXPECT_FALSE(summary.rms_lateral_error_m);
}

TEST_F(SummaryTest, CountsStepsThatWereNotSolvedAndDeadlineMissesAcrossTheWrap) {
  const Scenario scenario =
      files_.Load("duration = 4.0\n[expect]\nmax_infeasible_steps = 2\nmax_deadline_misses = 4\n");
  int cycle = 0;
  const Summary summary = Drive(scenario, [&cycle](FakeDaemon& controller, VirtualVehicle&) {
    ++cycle;
    controller.solver_status =
        cycle >= 40 && cycle < 43 ? bus::SolverStatus::kInfeasible : bus::SolverStatus::kSolved;
    controller.deadline_misses = cycle < 50 ? 1022 : 3;
  });
  EXPECT_EQ(summary.infeasible_steps, 3);
  EXPECT_EQ(summary.deadline_misses, 5);
  EXPECT_THAT(summary.failed_expectations,
              ElementsAre("infeasible_steps = 3 is above 2", "deadline_misses = 5 is above 4"));
}

TEST_F(SummaryTest, TellsTheFirstAndTheWorstOfWhatWasNotMet) {
  using enum bus::ConstraintVerdict;
  const Scenario scenario = files_.Load("duration = 4.0\n");
  int cycle = 0;
  std::int64_t first = 0;
  const Summary summary = Drive(scenario, [&](FakeDaemon& controller, VirtualVehicle&) {
    ++cycle;
    controller.constraint = bus::ConstraintReport{};
    if (controller.mode != bus::Mode::kActive) return;
    if (first == 0) first = cycle;
    const std::int64_t step = cycle - first;  // counted from the cycle after the one that engages
    if (step >= 9 && step < 12)
      controller.constraint = {.verdict = kRelaxed,
                               .constraint = bus::ConstraintName::kObstacle,
                               .index = 3,
                               .step = 20,
                               .amount = 0.01 * static_cast<double>(step)};
    if (step == 20)
      controller.constraint = {.verdict = kRejected,
                               .constraint = bus::ConstraintName::kRoad,
                               .index = 1,
                               .step = 5,
                               .amount = 0.05};
  });
  EXPECT_EQ(summary.relaxed_steps, 3);
  EXPECT_EQ(summary.rejected_plans, 1);
  ASSERT_TRUE(summary.first_unmet && summary.worst_unmet);
  EXPECT_EQ(summary.first_unmet->step, 10);
  EXPECT_EQ(summary.worst_unmet->step, 12);
  const nlohmann::json json = nlohmann::json::parse(ToJson(summary));
  const nlohmann::json first_unmet{{"step", 10}, {"verdict", "relaxed"}, {"constraint", "obstacle"},
                                   {"index", 3}, {"horizon_step", 20},   {"amount", 0.09}};
  EXPECT_EQ(json["first_unmet"], first_unmet);
  EXPECT_NEAR(json["worst_unmet"]["amount"], 0.11, 1e-9);
  EXPECT_THAT(ToText(summary), HasSubstr("step 10: obstacle 3 at i = 20, by 0.090 (relaxed)"));
}

TEST(SummaryJson, HasTheAgreedKeys) {
  Summary summary;
  summary.min_road_margin_m = 1.5;
  const nlohmann::ordered_json json = nlohmann::ordered_json::parse(ToJson(summary));
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys, ElementsAre("completed", "time_is_up", "steps", "infeasible_steps", "relaxed_steps",
                                "rejected_plans", "first_unmet", "worst_unmet", "min_clearance_m",
                                "min_road_margin_m", "contact_step", "contact_fault", "off_road_step",
                                "standing", "rms_lateral_error_m", "solve_time_us", "deadline_misses",
                                "max_speed_excess_mps", "rms_steering_rate", "p99_steering_rate", "rms_jerk",
                                "p99_jerk", "longest_free_standstill_s", "end_overshoot_m", "mode_changes",
                                "safe_stops", "min_time_to_collision_s", "passed", "failed_expectations"));
  EXPECT_TRUE(json["min_clearance_m"].is_null());
  EXPECT_TRUE(json["first_unmet"].is_null());
  EXPECT_EQ(json["min_road_margin_m"], 1.5);
  EXPECT_EQ(json["solve_time_us"].size(), 3u);
  EXPECT_TRUE(json["solve_time_us"].contains("p99"));
}

}  // namespace
}  // namespace sim
