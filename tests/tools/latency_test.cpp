// A drive with 50 ms of dead time in the loop, in addition to the actuators' lag.
#include <gtest/gtest.h>

#include "config/route_file.hpp"
#include "tools/drive/drive_figures.hpp"

namespace {

const std::filesystem::path kWholeDrive = LPVMPC_SOURCE_DIR "/scenarios/whole_drive";

tools::DriveFigures Drive(int delay_cycles, base::Time assumed) {
  loop::Config config = loop::LoadConfig(kWholeDrive / "lpvmpcd.toml");
  config.loop.command_delay = assumed;
  sim::Scenario scenario = sim::LoadScenario(kWholeDrive / "scenario.toml");
  scenario.steering.delay_cycles = scenario.acceleration.delay_cycles = delay_cycles;
  return tools::MeasureDrive(scenario, config, config::LoadRoute(config.route),
                             {.Q = control::State::Zero(), .R = control::Input::Zero()});
}

TEST(Latency, Of50MsNeitherEndsTheDriveNorMakesTheWheelSwing) {
  using namespace std::chrono_literals;
  const tools::DriveFigures without = Drive(0, 0ms);
  ASSERT_TRUE(without.summary.passed());
  for (const base::Time assumed : {0ms, 50ms, 100ms}) {
    const tools::DriveFigures with = Drive(1, assumed);
    EXPECT_TRUE(with.summary.passed()) << assumed.count();
    EXPECT_EQ(with.summary.rejected_plans, 0);
    EXPECT_LT(with.rms_steering_rate, 1.5 * without.rms_steering_rate) << assumed.count();
    EXPECT_LT(*with.summary.rms_lateral_error_m, 1.1 * *without.summary.rms_lateral_error_m);
  }
}

}  // namespace
