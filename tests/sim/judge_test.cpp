// What the judge of a drive asks beyond contact, road and time.
#include <nlohmann/json.hpp>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/sim/drive_test.hpp"

namespace sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// A straight road of 100 m from X = 10 m on.
class JudgeTest : public DriveTest {
 protected:
  JudgeTest() {
    files_.Write("route.toml",
                 "[route]\nspeed = 12\nstart = {X = 10, Y = 0, psi = 0}\n"
                 "pieces = [{kind = \"straight\", length = 100}]\n[road]\nleft = 4\nright = 4\n");
  }

  // With the acceleration that `demand` gives at a time.
  template <typename F>
  Summary DriveWithAcceleration(const std::string& text, const F& demand) {
    return Drive(files_.Load(text), [&demand](FakeDaemon& controller, const VirtualVehicle& vehicle) {
      controller.acceleration = demand(vehicle);
    });
  }
};

const std::string kCar = "[vehicle]\nfront = 1.95\nrear = 2.3\nwidth = 1.8\n";
const std::string kWall = "[[obstacle]]\nid = 1\ns = 20\nr_x = 1\nr_y = 5\n";

TEST_F(JudgeTest, SpeedOverTheTargetIsTold) {
  const auto faster = [](const VirtualVehicle& vehicle) {
    return vehicle.time() > 1.98 && vehicle.time() < 2.98 ? 1.0 : 0.0;
  };
  const Summary summary =
      DriveWithAcceleration("duration = 4.0\n[expect]\nmax_speed_excess_mps = 0.5\n", faster);
  EXPECT_NEAR(*summary.max_speed_excess_mps, 1.0, 0.01);
  ASSERT_EQ(summary.failed_expectations.size(), 1u);
  EXPECT_THAT(summary.failed_expectations[0], HasSubstr("is above 0.5"));
}

TEST_F(JudgeTest, SpeedBelowTheTargetIsNoExcess) {
  const Summary summary = Drive("duration = 3.0\n[initial]\nspeed = 9\n");
  EXPECT_EQ(summary.max_speed_excess_mps, 0.0);
}

TEST_F(JudgeTest, SteeringRateAndJerkAreThoseOfTheCommands) {
  bool up = false;
  const Summary summary =
      Drive(files_.Load("duration = 4.0\n[expect]\nmax_rms_steering_rate = 0.3\nmax_p99_steering_rate = 0.5\n"
                        "max_rms_jerk = 5.0\nmax_p99_jerk = 3.0\n"),
            [&up](FakeDaemon& controller, VirtualVehicle&) {
              up = !up;
              controller.steering = up ? 0.01 : -0.01;
              controller.acceleration = up ? 0.1 : -0.1;
            });
  EXPECT_NEAR(*summary.rms_steering_rate, 0.02 / kCycleTime, 1e-3);
  EXPECT_NEAR(*summary.p99_steering_rate, 0.02 / kCycleTime, 1e-3);
  EXPECT_NEAR(*summary.rms_jerk, 0.2 / kCycleTime, 0.02);
  EXPECT_NEAR(*summary.p99_jerk, 0.2 / kCycleTime, 0.02);
  EXPECT_THAT(summary.failed_expectations,
              ElementsAre(HasSubstr("rms_steering_rate"), HasSubstr("p99_jerk")));
}

TEST_F(JudgeTest, StandingOnAFreeRoadIsADeadlockAndNeverCompleted) {
  // Rolls, stops after about 2.4 s and stays.
  const auto brake = [](const VirtualVehicle& vehicle) { return vehicle.time() > 1.0 ? -3.0 : 0.0; };
  const std::string drive = "[initial]\nspeed = 4\n" + kCar;
  const Summary summary =
      DriveWithAcceleration("duration = 10.0\n" + drive + "[expect]\nmax_free_standstill_s = 3.0\n", brake);
  EXPECT_NEAR(summary.longest_free_standstill_s, 10.0 - 1.0 - 4.0 / 3.0, 0.2);
  EXPECT_FALSE(summary.completed);
  EXPECT_TRUE(summary.time_is_up);
  EXPECT_THAT(ToText(summary), HasSubstr("time is up"));
  EXPECT_THAT(summary.failed_expectations,
              ElementsAre("completed = false", HasSubstr("longest_free_standstill_s = 7.")));
  // Standing for less than 5 s may yet be a pause.
  const Summary pause = DriveWithAcceleration("duration = 6.0\n" + drive, brake);
  EXPECT_TRUE(pause.completed);
  EXPECT_TRUE(pause.time_is_up);
}

TEST_F(JudgeTest, WaitingWithCauseIsCompletedWhenTheTimeIsUp) {
  const auto brake = [](const VirtualVehicle& vehicle) { return vehicle.time() > 1.0 ? -3.0 : 0.0; };
  const Summary summary =
      DriveWithAcceleration("duration = 10.0\n[initial]\nspeed = 4\n" + kWall + kCar, brake);
  EXPECT_EQ(summary.longest_free_standstill_s, 0.0);
  EXPECT_TRUE(summary.completed);
  EXPECT_TRUE(summary.time_is_up);
}

TEST_F(JudgeTest, VehicleThatNeverMovedHasNotCompletedItsDrive) {
  const Summary summary = Drive("duration = 4.0\n[initial]\nspeed = 0\nalong = 8\n" + kWall + kCar);
  EXPECT_GT(summary.steps, 60);
  EXPECT_EQ(summary.longest_free_standstill_s, 0.0);
  EXPECT_FALSE(summary.completed);
}

TEST_F(JudgeTest, StandingCountsFromWhenTheBlockedRoadHasCleared) {
  const Summary summary =
      Drive("duration = 8.0\n[initial]\nspeed = 0\nalong = 10\n" + kWall + "disappears_at = 5.0\n" + kCar);
  EXPECT_NEAR(summary.longest_free_standstill_s, 3.0, 0.06);
}

TEST_F(JudgeTest, StandingAtTheEndOfTheRouteIsNoStandstill) {
  const Summary summary = Drive("duration = 4.0\n[initial]\nspeed = 0\nalong = 99.5\n" + kCar);
  EXPECT_EQ(summary.longest_free_standstill_s, 0.0);
  EXPECT_FALSE(summary.time_is_up);
}

TEST_F(JudgeTest, OvershootIsMeasuredUntilTheVehicleStands) {
  const auto late = [](const VirtualVehicle& vehicle) {
    return vehicle.state()[control::kX] >= 110.0 ? -4.0 : 0.0;
  };
  const Summary summary = DriveWithAcceleration("[expect]\nmax_end_overshoot_m = 0.3\n", late);
  EXPECT_TRUE(summary.completed);
  EXPECT_TRUE(summary.standing);
  EXPECT_GT(*summary.end_overshoot_m, 12.0 * 12.0 / 8.0 - 0.1);  // and up to a cycle's way
  EXPECT_LT(*summary.end_overshoot_m, 12.0 * 12.0 / 8.0 + 0.7);
  EXPECT_THAT(summary.failed_expectations, ElementsAre(HasSubstr("end_overshoot_m = 18.")));
  // Without the expectation, the drive ends at the end.
  EXPECT_LT(*DriveWithAcceleration("", late).end_overshoot_m, 0.61);
}

TEST_F(JudgeTest, GapBeforeTheEndIsANegativeOvershoot) {
  // From X = 90 m on, 12 m/s are braked away within 18 m: up to a cycle's way more than 2 m are left.
  const auto early = [](const VirtualVehicle& vehicle) {
    return vehicle.state()[control::kX] >= 89.99 ? -4.0 : 0.0;
  };
  const Summary summary = DriveWithAcceleration("duration = 14.0\n[expect]\nmax_end_gap_m = 0.3\n", early);
  EXPECT_NEAR(*summary.end_overshoot_m, -1.7, 0.4);
  EXPECT_THAT(summary.failed_expectations, testing::Contains(HasSubstr("is above 0.3")));
}

TEST_F(JudgeTest, EndThatWasNotReachedIsTooGreatAGap) {
  const Summary summary = Drive("duration = 3.0\n[expect]\nmax_end_gap_m = 0.3\n");
  EXPECT_FALSE(summary.end_overshoot_m);
  EXPECT_THAT(summary.failed_expectations, ElementsAre("end_overshoot_m: the end was not reached"));
}

TEST_F(JudgeTest, ModeChangesAndSafeStopsAreCounted) {
  int cycle = 0;
  const Summary summary =
      Drive(files_.Load("duration = 4.0\n[expect]\nmax_mode_changes = 3\nmax_safe_stops = 0\n"),
            [&cycle](FakeDaemon& controller, VirtualVehicle&) {
              ++cycle;
              if (cycle == 30) controller.mode = bus::Mode::kDegraded;
              if (cycle == 35) controller.mode = bus::Mode::kActive;
              if (cycle == 40) controller.mode = bus::Mode::kSafeStop;
              if (cycle == 45) controller.mode = bus::Mode::kActive;
            });
  EXPECT_EQ(summary.mode_changes, 4);
  EXPECT_EQ(summary.safe_stops, 1);
  EXPECT_THAT(summary.failed_expectations,
              ElementsAre("mode_changes = 4 is above 3", "safe_stops = 1 is above 0"));
}

TEST_F(JudgeTest, EndingTheDriveAtTheEndIsNoModeChange) {
  const Summary summary = Drive(files_.Load("[expect]\nmax_end_overshoot_m = 100.0\n"),
                                [](FakeDaemon& controller, const VirtualVehicle& vehicle) {
                                  if (vehicle.state()[control::kX] < 105.0) return;
                                  controller.fault_code = bus::FaultCode::kRouteEnd;
                                  const bool stands = vehicle.state()[control::kUpsilon] < 0.05;
                                  controller.mode = stands ? bus::Mode::kStandby : bus::Mode::kSafeStop;
                                });
  EXPECT_TRUE(summary.standing);
  EXPECT_EQ(summary.mode_changes, 0);
  EXPECT_EQ(summary.safe_stops, 0);
}

TEST_F(JudgeTest, TimeToCollisionIsTheGapOverTheClosingSpeed) {
  // At 4.95 s, the last cycle, the front is at X = 69.4 + 1.95 m, the obstacle's edge at 99 - 3 * 4.95 m.
  const std::string drive = "duration = 5.0\n" + kCar + "[expect]\nmin_time_to_collision_s = 1.0\n";
  const std::string oncoming = "[[obstacle]]\nid = 1\nX = 100\nr_x = 1\nr_y = 1\nvelocity_X = -3\nY = ";
  const Summary ahead = Drive(drive + oncoming + "0\n");
  EXPECT_NEAR(*ahead.min_time_to_collision_s, (99.0 - 14.85 - 71.35) / 15.0, 1e-3);
  EXPECT_THAT(ahead.failed_expectations, ElementsAre(HasSubstr("min_time_to_collision_s = 0.85")));
  EXPECT_FALSE(Drive(drive + oncoming + "2.5\n").min_time_to_collision_s);
}

TEST_F(JudgeTest, DrivingIntoAnObstacleIsOurFault) {
  const Summary summary = Drive("duration = 5.0\n[[obstacle]]\nid = 1\ns = 40\nr_x = 1\nr_y = 1\n" + kCar);
  EXPECT_EQ(summary.contact_fault, ContactFault::kOurs);
  EXPECT_EQ(nlohmann::json::parse(ToJson(summary))["contact_fault"], "ours");
  EXPECT_THAT(ToText(summary), HasSubstr(", ours"));
}

TEST_F(JudgeTest, BeingRunIntoFromBehindIsTheirFault) {
  const Summary summary =
      Drive("duration = 3.0\n[[obstacle]]\nid = 1\nX = 0\nY = 0\nr_x = 1\nr_y = 1\nvelocity_X = 20\n" + kCar +
            "[expect]\nmin_clearance_m = 0\n");
  EXPECT_EQ(summary.contact_fault, ContactFault::kTheirs);
  EXPECT_EQ(nlohmann::json::parse(ToJson(summary))["contact_fault"], "theirs");
  EXPECT_THAT(summary.failed_expectations, ElementsAre(HasSubstr("min_clearance_m = -")));
}

TEST_F(JudgeTest, BeingHitAtStandstillIsTheirFault) {
  const Summary summary = Drive(
      "duration = 6.0\n[initial]\nspeed = 0\n[[obstacle]]\nid = 1\ns = 40\nr_x = 1\nr_y = 1\n"
      "velocity_X = -10\n" +
      kCar);
  EXPECT_EQ(summary.contact_fault, ContactFault::kTheirs);
}

TEST_F(JudgeTest, OneContactOfOursAmongTheirsIsOurs) {
  const Summary summary = Drive(
      "duration = 6.0\n[[obstacle]]\nid = 1\nX = 0\nY = 0\nr_x = 1\nr_y = 1\nvelocity_X = 20\n"
      "[[obstacle]]\nid = 2\ns = 50\nr_x = 1\nr_y = 1\n" +
      kCar);
  EXPECT_EQ(summary.contact_fault, ContactFault::kOurs);
}

TEST_F(JudgeTest, NoContactIsNobodysFault) {
  const Summary summary = Drive("duration = 3.0\n");
  EXPECT_FALSE(summary.contact_fault);
  EXPECT_TRUE(nlohmann::json::parse(ToJson(summary))["contact_fault"].is_null());
  EXPECT_THAT(ToText(summary), Not(HasSubstr("contact")));
  EXPECT_THAT(summary.failed_expectations, IsEmpty());
}

TEST(SpeedExcess, StartThatIsTooFastMayBeBrakedAwayGently) {
  SpeedExcess gentle(0.1), sluggish(0.1), again(0.1);
  for (int k = 0; k < 60; ++k) {
    const double time = 0.1 * k;
    gentle.Take(std::max(15.0 - time, 12.0), 12.0);
    sluggish.Take(15.0 - 0.5 * time, 12.0);
    again.Take(k < 10   ? 15.0
               : k < 20 ? 12.0
                        : 13.0,
               12.0);  // the allowance ends with the first time at the target
  }
  EXPECT_NEAR(*gentle.Greatest(), 0.0, 1e-12);
  EXPECT_NEAR(*sluggish.Greatest(), 1.5, 1e-12);  // at 3 s, when 12 m/s are allowed
  EXPECT_NEAR(*again.Greatest(), 1.0, 1e-12);
  EXPECT_FALSE(SpeedExcess(0.1).Greatest());
}

TEST(RateFigures, GapsInTheCommandsAreNoRates) {
  RateFigures rates(0.1);
  EXPECT_FALSE(rates.Rms() || rates.P99());
  for (int k = 0; k < 100; ++k) rates.Take(0.3 * (k % 2));  // 3 per second, 99 times
  rates.Take(std::nullopt);
  rates.Take(50.0);
  EXPECT_NEAR(*rates.Rms(), 3.0, 1e-12);
  rates.Take(51.0);
  EXPECT_NEAR(*rates.Rms(), std::sqrt((99.0 * 9.0 + 100.0) / 100.0), 1e-12);
  EXPECT_NEAR(*rates.P99(), 3.0, 1e-12);  // one of 100 may be above
}

TEST(LongestRun, IsTheLongestWithoutABreak) {
  LongestRun run(0.5);
  for (const bool holds : {true, true, true, false, true, true}) run.Take(holds);
  EXPECT_EQ(run.longest(), 1.5);
  EXPECT_EQ(run.present(), 1.0);
}

}  // namespace
}  // namespace sim
