#include "loop/config.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/toml_table.hpp"
#include "loop/assembly.hpp"
#include "tests/support/temp_dir.hpp"

namespace loop {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ConfigTest : public testing::Test {
 protected:
  test_support::TempDir folder_;

  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  Config Load(const std::string& text) const { return LoadConfig(Write("daemon.toml", text)); }
  // The error text of a configuration that must be rejected.
  std::string Error(const std::string& text) const {
    try {
      static_cast<void>(Load(text));
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    ADD_FAILURE() << "accepted: " << text;
    return "";
  }
};

const std::string kRoute = "[route]\nfile = \"route.toml\"\n";

TEST_F(ConfigTest, RouteIsAllThatIsRequiredAndItsPathIsRelativeToTheFile) {
  const Config config = Load(kRoute);
  EXPECT_EQ(config.route, folder_ / "route.toml");
  EXPECT_EQ(config.service.interface, "can0");
  EXPECT_EQ(config.service.timeout, base::FromSeconds(0.075));
  EXPECT_STREQ(ControllerName(config.controller), "lpv-affine");
  EXPECT_THAT(Error(""), HasSubstr("file"));
}

TEST_F(ConfigTest, LimitsHoldForTheProblemAndForTheLimiter) {
  const Config config = Load(kRoute + "[limits]\nmax_steering = 0.3\nmin_acceleration = -4\n");
  EXPECT_EQ(config.loop.limits.max_steering, 0.3);
  EXPECT_EQ(config.mpc.u_max[control::kDelta], 0.3);
  EXPECT_EQ(config.mpc.u_min, control::Input(-0.3, -4.0));
  EXPECT_EQ(config.loop.limits.max_acceleration, config.mpc.u_max[control::kAcceleration]);
  EXPECT_EQ(config.loop.limits.max_steering_step, config.mpc.rate_max[control::kDelta]);
}

TEST_F(ConfigTest, APlanOfLpvAffineKeepsItsOwnRatesWithinTheLimits) {
  const Config slow = Load(kRoute + "[lpv_affine]\nmax_steering_rate = 0.4\nmax_jerk = 10\n");
  EXPECT_NEAR(slow.affine.rate_max[control::kDelta], 0.02, 1e-12);
  EXPECT_NEAR(slow.affine.rate_max[control::kAcceleration], 0.5, 1e-12);
  const Config limited =
      Load(kRoute + "[limits]\nmax_steering = 0.3\nmax_steering_step = 0.01\nmax_acceleration_step = 0.2\n");
  EXPECT_EQ(limited.affine.rate_max, control::Input(0.01, 0.2));
  EXPECT_EQ(limited.affine.u_max, limited.mpc.u_max);
  EXPECT_EQ(limited.affine.u_min, limited.mpc.u_min);
}

TEST_F(ConfigTest, DefaultsOfTheSettingsAreThoseOfAFileThatGivesNone) {
  const Config file = Load(kRoute);
  const Config settings;
  const auto same_limits = [](const auto& a, const auto& b) {
    return a.horizon == b.horizon && a.t_s == b.t_s && a.Q == b.Q && a.R == b.R && a.u_min == b.u_min &&
           a.u_max == b.u_max && a.rate_max == b.rate_max && a.obstacle_margin == b.obstacle_margin &&
           a.trust_radius == b.trust_radius;
  };
  EXPECT_TRUE(same_limits(file.affine, settings.affine));
  EXPECT_TRUE(same_limits(file.mpc, settings.mpc));
  EXPECT_EQ(file.mpc.P, settings.mpc.P);
  EXPECT_EQ(file.mpc.E_p, settings.mpc.E_p);
  EXPECT_EQ(file.mpc.z_min, settings.mpc.z_min);
  EXPECT_EQ(file.mpc.z_max, settings.mpc.z_max);
  EXPECT_EQ(file.affine.R_rate, settings.affine.R_rate);
  EXPECT_EQ(file.affine.terminal, settings.affine.terminal);
  EXPECT_EQ(file.affine.mu, settings.affine.mu);
  EXPECT_EQ(file.affine.friction_share, settings.affine.friction_share);
  EXPECT_EQ(file.affine.road_margin, settings.affine.road_margin);
  EXPECT_EQ(file.affine.stop_gap, settings.affine.stop_gap);
  EXPECT_EQ(file.affine.footprint.half_width, settings.affine.footprint.half_width);
  EXPECT_EQ(file.affine.trust_region, settings.affine.trust_region);
  EXPECT_EQ(file.mpc.trust_region, settings.mpc.trust_region);
  EXPECT_EQ(file.mpc.discretisation, settings.mpc.discretisation);
  EXPECT_EQ(file.loop.engage_min_speed, settings.loop.engage_min_speed);
  EXPECT_EQ(file.loop.standstill_speed, settings.loop.standstill_speed);
  EXPECT_EQ(file.loop.monitor.stale_periods, settings.loop.monitor.stale_periods);
  EXPECT_EQ(file.service.interface, settings.service.interface);
  EXPECT_EQ(file.service.period, settings.service.period);
  EXPECT_EQ(file.affine.adapt_trust_region, settings.affine.adapt_trust_region);
  EXPECT_EQ(file.affine.iterations, settings.affine.iterations);
  EXPECT_EQ(file.speed.lateral, settings.speed.lateral);
  EXPECT_EQ(file.speed.acceleration, settings.speed.acceleration);
  EXPECT_EQ(file.speed.deceleration, settings.speed.deceleration);
  EXPECT_EQ(file.loop.period, settings.loop.period);
  EXPECT_EQ(file.loop.deadline, settings.loop.deadline);
  EXPECT_EQ(file.loop.command_delay, settings.loop.command_delay);
  EXPECT_EQ(file.loop.limits.max_steering, settings.loop.limits.max_steering);
  EXPECT_EQ(file.loop.limits.max_acceleration_step, settings.loop.limits.max_acceleration_step);
  EXPECT_EQ(file.loop.modes.degraded_cycles, settings.loop.modes.degraded_cycles);
  EXPECT_EQ(file.loop.stop_deceleration, settings.loop.stop_deceleration);
  EXPECT_EQ(file.service.timeout, settings.service.timeout);
  EXPECT_EQ(file.log_level, settings.log_level);
}

// Defaults of the controllers, the loop and the service, as far as the configuration sets these values.
TEST(Config, DefaultsOfEachRoomAreThoseOfTheConfiguration) {
  const Config config;
  const LoopSettings loop;
  EXPECT_EQ(loop.period, config.loop.period);
  EXPECT_EQ(loop.deadline, config.loop.deadline);
  EXPECT_EQ(loop.engage_min_speed, config.loop.engage_min_speed);
  EXPECT_EQ(loop.modes.degraded_cycles, config.loop.modes.degraded_cycles);
  EXPECT_EQ(loop.vehicle.m, config.vehicle.m);
  const ServiceSettings service;
  EXPECT_EQ(service.period, config.service.period);
  EXPECT_EQ(service.timeout, config.service.timeout);
  const control::LpvMpcSettings mpc;
  EXPECT_EQ(mpc.t_s, config.mpc.t_s);
  EXPECT_EQ(mpc.P, config.mpc.P);
  EXPECT_EQ(mpc.u_min, config.mpc.u_min);
  EXPECT_EQ(mpc.u_max, config.mpc.u_max);
  EXPECT_EQ(mpc.rate_max, config.mpc.rate_max);
  const control::LpvAffineSettings affine;
  EXPECT_EQ(affine.t_s, config.affine.t_s);
  EXPECT_EQ(affine.u_min, config.affine.u_min);
  EXPECT_EQ(affine.u_max, config.affine.u_max);
  EXPECT_EQ(affine.rate_max, config.affine.rate_max);
}

TEST_F(ConfigTest, TrustRegionOfLpvAffineIsAdaptiveFixedOrNone) {
  EXPECT_TRUE(Load(kRoute).affine.adapt_trust_region);
  const Config fixed = Load(kRoute + "[lpv_affine]\ntrust_region = \"fixed\"\n");
  EXPECT_TRUE(fixed.affine.trust_region);
  EXPECT_FALSE(fixed.affine.adapt_trust_region);
  EXPECT_FALSE(Load(kRoute + "[lpv_affine]\ntrust_region = \"none\"\n").affine.trust_region);
  EXPECT_THAT(Error(kRoute + "[lpv_affine]\ntrust_region = \"wide\"\n"), HasSubstr("adaptive"));
}

TEST_F(ConfigTest, LpvAffineSetsOffFromStandstillAndThePapersControllersDoNot) {
  Config config = Load(kRoute);
  EXPECT_FALSE(IsPapers(config.controller));
  EXPECT_EQ(config.loop.engage_min_speed, 0.0);
  SelectController(config, "lpv");
  EXPECT_TRUE(IsPapers(config.controller));
  EXPECT_EQ(config.loop.engage_min_speed, 3.0);
  Config written = Load(kRoute + "[engage]\nmin_speed = 1.5\n");
  EXPECT_EQ(written.loop.engage_min_speed, 1.5);
  SelectController(written, "lpv");
  EXPECT_EQ(written.loop.engage_min_speed, 1.5);
}

TEST_F(ConfigTest, LpvAffineIsOffsetFreeUnlessSwitchedOffAndThePapersControllersAreNot) {
  Config config = Load(kRoute);
  EXPECT_TRUE(config.loop.offset_free);
  SelectController(config, "lpv");
  EXPECT_FALSE(config.loop.offset_free);
  SelectController(config, "nmpc-affine");
  EXPECT_TRUE(config.loop.offset_free);
  EXPECT_FALSE(Load(kRoute + "[controller]\noffset_free = false\n").loop.offset_free);
}

TEST_F(ConfigTest, TheVehiclesRectangleIsGivenByItsEndsAndItsWidth) {
  const Config config = Load(kRoute + "[vehicle]\nfront = 2.5\nrear = 1.5\nwidth = 2\n");
  EXPECT_EQ(config.affine.footprint.front, 2.5);
  EXPECT_EQ(config.affine.footprint.rear, 1.5);
  EXPECT_EQ(config.affine.footprint.half_width, 1.0);
  EXPECT_THAT(Error(kRoute + "[vehicle]\nwidth = -1\n"), HasSubstr("width"));
}

TEST_F(ConfigTest, PeriodHoldsForBusReferenceAndController) {
  const Config config = Load(kRoute + "[cycle]\nperiod = 0.02\n");
  EXPECT_EQ(config.mpc.t_s, 0.02);
  EXPECT_EQ(config.loop.period, base::FromSeconds(0.02));
  EXPECT_EQ(config.service.timeout, base::FromSeconds(0.03));
}

TEST_F(ConfigTest, DeadlineIsThePeriodUnlessGivenAndThereIsNoneInLockStep) {
  EXPECT_EQ(Load(kRoute + "[cycle]\nperiod = 0.02\n").loop.deadline, base::FromSeconds(0.02));
  EXPECT_EQ(Load(kRoute + "[cycle]\ndeadline = 0.03\n").loop.deadline, base::FromSeconds(0.03));
  EXPECT_THAT(Error(kRoute + "[cycle]\nperiod = 0.02\ndeadline = 0.03\n"), HasSubstr("deadline"));
  EXPECT_THAT(Error(kRoute + "[cycle]\ndeadline = 0\n"), HasSubstr("0.001"));
  Config config = Load(kRoute + "[cycle]\ndeadline = 0.03\nlockstep = true\n");
  EXPECT_EQ(config.loop.deadline, base::Time::max());
  config = Load(kRoute + "[cycle]\ndeadline = 0.03\n");
  SelectLockstep(config);
  EXPECT_TRUE(config.service.lockstep);
  EXPECT_EQ(config.loop.deadline, base::Time::max());
}

TEST_F(ConfigTest, NothingOfRealTimeIsAskedForUnlessWritten) {
  const RealTimeSettings usual = Load(kRoute).service.real_time;
  EXPECT_EQ(usual.fifo_priority, 0);
  EXPECT_FALSE(usual.lock_memory);
  EXPECT_TRUE(usual.cpus.empty());
  const RealTimeSettings settings =
      Load(kRoute + "[realtime]\nfifo_priority = 50\nlock_memory = true\ncpus = [1, 3]\n").service.real_time;
  EXPECT_EQ(settings.fifo_priority, 50);
  EXPECT_TRUE(settings.lock_memory);
  EXPECT_EQ(settings.cpus, (std::vector<int>{1, 3}));
  EXPECT_THAT(Error(kRoute + "[realtime]\nfifo_priority = 100\n"), HasSubstr("[0, 99]"));
  EXPECT_THAT(Error(kRoute + "[realtime]\ncpus = [0, 1024]\n"), HasSubstr("cpus[1]"));
  EXPECT_THAT(Error(kRoute + "[realtime]\ncpus = [0.5]\n"), HasSubstr("0.5"));
}

TEST_F(ConfigTest, LastWeightsAreThoseOfTheOtherStepsUnlessGiven) {
  EXPECT_EQ(Load(kRoute + "[controller]\nQ = [1, 2, 3, 4, 5, 6]\n").mpc.P[5], 6.0);
  EXPECT_EQ(Load(kRoute + "[controller]\nP = [1, 2, 3, 4, 5, 6]\n").mpc.P[1], 2.0);
}

TEST_F(ConfigTest, ControllerCanBeChosen) {
  Config config = Load(kRoute + "[controller]\nkind = \"lpv-standard\"\n");
  EXPECT_STREQ(ControllerName(config.controller), "lpv-standard");
  EXPECT_FALSE(config.mpc.trust_region);
  SelectController(config, "lpv");
  EXPECT_TRUE(config.mpc.trust_region);
  EXPECT_THROW(SelectController(config, "pid"), std::invalid_argument);
}

TEST_F(ConfigTest, WrongValueNamesFileLineKeyValueAndWhatIsAllowed) {
  const std::string prefix = (folder_ / "daemon.toml").string() + ":4: ";
  std::string error = Error(kRoute + "[cycle]\nperiod = 7\n");
  EXPECT_THAT(error, StartsWith(prefix));
  EXPECT_THAT(error, HasSubstr("period"));
  EXPECT_THAT(error, HasSubstr("7"));
  EXPECT_THAT(error, HasSubstr("0.005"));
  EXPECT_THAT(Error(kRoute + "[controller]\nhorizon = \"long\"\n"), StartsWith(prefix));
  EXPECT_THAT(Error(kRoute + "[controller]\nR = [0.1]\n"), StartsWith(prefix));
  EXPECT_THAT(Error(kRoute + "[controller]\nR = [0.1, 0]\n"), StartsWith(prefix));
  EXPECT_THAT(Error(kRoute + "[controller]\nkind = \"pid\"\n"), HasSubstr("lpv-standard"));
  EXPECT_THAT(Error(kRoute + "[controller]\nhorizn = 8\n"), HasSubstr("horizn"));
  EXPECT_THAT(Error(kRoute + "[contoller]\nhorizon = 8\n"), HasSubstr("contoller"));
}

TEST_F(ConfigTest, ValuesThatContradictEachOtherAreRefused) {
  EXPECT_THAT(Error(kRoute + "[cycle]\ntimeout = 0.01\n"), HasSubstr("timeout"));
  EXPECT_THAT(Error(kRoute + "[controller]\nz_max = [0, 0, 0, 0, 0, 0]\n"), HasSubstr("z_max"));
  // A stop that the limiter would not permit: both keys matter, and either may be the one in the file.
  EXPECT_THAT(Error(kRoute + "[safe_stop]\ndeceleration = 7\n"), HasSubstr("deceleration"));
  EXPECT_THAT(Error(kRoute + "[limits]\nmin_acceleration = -2\n"),
              testing::AllOf(HasSubstr("safe_stop.deceleration"), HasSubstr("limits.min_acceleration")));
  EXPECT_EQ(Load(kRoute + "[limits]\nmin_acceleration = -2\n[safe_stop]\ndeceleration = 2\n")
                .loop.stop_deceleration,
            2.0);
}

TEST_F(ConfigTest, AssemblyNamesTheFileThatIsMissingOrWrong) {
  const auto error_of = [](const Config& config) -> std::string {
    try {
      const Assembly assembly(config, [] { return base::Time{}; });
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  Config config = Load(kRoute);
  EXPECT_THAT(error_of(config), HasSubstr("route.toml"));

  Write("route.toml",
        "[route]\nstart = {X = 0.0, Y = 0.0, psi = 0.0}\nspeed = 10.0\npieces = [{kind = \"straight\", "
        "length = 100.0}]\n"
        "[road]\nleft = 4.0\nright = 4.0\n");
  EXPECT_EQ(error_of(config), "");

  for (const char* nonlinear : {"nmpc", "nmpc-affine"}) {
    SelectController(config, nonlinear);
    EXPECT_THAT(error_of(config), HasSubstr(std::string(nonlinear) + " is for lpvmpc alone"));
  }
  SelectController(config, "lpv");

  config.dbc = folder_ / "none.dbc";
  EXPECT_THAT(error_of(config), HasSubstr("none.dbc"));
  config.dbc = Write("wrong.dbc", "VERSION \"1\"\nBO_ 256 VehiclePose 8 Vehicle\n");
  EXPECT_THAT(error_of(config), HasSubstr("wrong.dbc:2:"));
  config.dbc = Write("empty.dbc", "VERSION \"1\"\n");
  EXPECT_THAT(error_of(config), StartsWith((folder_ / "empty.dbc").string() + ": there is no message"));
  config.dbc = folder_.path();
  EXPECT_THAT(error_of(config), HasSubstr("cannot be read"));

  config.dbc.clear();
  config.mpc.horizon = 100;
  EXPECT_EQ(error_of(config), "");
  Write("route.toml",
        "[route]\nstart = {X = 0.0, Y = 0.0, psi = 0.0}\nspeed = 10.0\npieces = [{kind = \"straight\", "
        "length = 10.0}]\n"
        "[road]\nleft = 4.0\nright = 4.0\n");
  EXPECT_THAT(error_of(config), HasSubstr("shorter than the horizon"));
}

}  // namespace
}  // namespace loop
