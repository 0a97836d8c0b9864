// A daemon whose controller fails in the middle of a curve, with the simulated vehicle on a real interface: the
// commands from the failure on, and the vehicle's margin to the road's edge.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bus/names.hpp"
#include "bus/vehicle_bus.hpp"
#include "can/candump_log.hpp"
#include "safety/mode_machine.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temp_dir.hpp"

namespace lpvmpcd {
namespace {

using namespace std::chrono_literals;

constexpr double kRadius = 60.0;
constexpr double kWheelbase = 2.44;
constexpr int kHorizon = 8;
// The arc begins after 70 m; the vehicle is engaged and on it when the controller fails.
constexpr const char* kRoute =
    "[route]\nstart = {X = 0.0, Y = 0.0, psi = 0.0}\nspeed = 12.0\npieces = [\n"
    "  {kind = \"straight\", length = 40.0},\n"
    "  {kind = \"clothoid\", length = 30.0, curvature_from = 0.0, curvature_to = 0.0166666666666667},\n"
    "  {kind = \"arc\", length = 220.0, radius = 60.0, turn = \"left\"},\n]\n[road]\nleft = 4.0\nright = "
    "4.0\n";
constexpr int kFirst = 140;  // first step of the controller that fails

// A cycle as seen on the bus.
struct Cycle {
  bus::SteeringCommand steering;
  bus::AccelerationCommand acceleration;
  bus::ControllerStatus status;
  bus::ControllerDiagnostics diagnostics;
  double speed = 0.0;  // last speed reported before it [m/s]
};

class FallbackInACurve : public testing::Test {
 protected:
  // Drives with `count` faults of `kind` from step kFirst on and reads the log.
  void Drive(const std::string& kind, int count, bool realtime) {
    const std::filesystem::path bin = folder_ / "bin";
    std::filesystem::create_directory(bin);
    std::filesystem::create_symlink(FAULTY_LPVMPCD, bin / "lpvmpcd");
    std::filesystem::create_symlink(LPVMPC_SIM, bin / "lpvmpc-sim");
    std::ofstream(folder_ / "route.toml") << kRoute;
    std::ofstream(folder_ / "daemon.toml") << "[route]\nfile = \"route.toml\"\n[controller]\nhorizon = 8\n"
                                              "discretisation = \"zero-order-hold\"\n";
    std::ofstream(folder_ / "scenario.toml") << "name = \"curve\"\nroute = \"route.toml\"\n";
    std::vector<std::string> command{
        "env", "LPVMPC_BIN=" + bin.string(),
        "LPVMPC_TEST_FAULT=" + kind + " " + std::to_string(kFirst) + " " + std::to_string(count),
        std::string(LPVMPC_SOURCE_DIR) + "/scripts/drive"};
    if (realtime) command.emplace_back("--realtime");
    const std::string out = (folder_ / "out").string();
    for (const std::string& file :
         {(folder_ / "scenario.toml").string(), (folder_ / "daemon.toml").string(), out}) {
      command.push_back(file);
    }
    const auto outcome = test_support::Run(command, 120s);
    ASSERT_TRUE(std::filesystem::exists(out + "/summary.json")) << outcome.err;
    summary_ = nlohmann::json::parse(std::ifstream(out + "/summary.json"));
    ReadCycles(out + "/candump.log");
    ASSERT_FALSE(cycles_.empty());
  }

  void ReadCycles(const std::string& log) {
    std::ifstream in(log);
    Cycle cycle;
    for (std::string line; std::getline(in, line);) {
      const auto entry = can::ParseCandumpLine(line);
      ASSERT_TRUE(entry && *entry) << line;
      const can::Frame& frame = (*entry)->frame;
      const auto message = bus_.Decode(frame.id, frame.Payload());
      ASSERT_TRUE(message) << line;
      if (const auto* motion = std::get_if<bus::VehicleMotion>(&*message)) {
        cycle.speed = motion->upsilon;
      } else if (const auto* steering = std::get_if<bus::SteeringCommand>(&*message)) {
        cycle.steering = *steering;
      } else if (const auto* acceleration = std::get_if<bus::AccelerationCommand>(&*message)) {
        cycle.acceleration = *acceleration;
      } else if (const auto* status = std::get_if<bus::ControllerStatus>(&*message)) {
        cycle.status = *status;
      } else if (const auto* diagnostics = std::get_if<bus::ControllerDiagnostics>(&*message)) {
        cycle.diagnostics = *diagnostics;
        cycles_.push_back(cycle);
      }
    }
  }

  // The first cycle in `mode`, from `begin` on.
  std::size_t First(bus::Mode mode, std::size_t begin = 0) const {
    const auto found = std::find_if(cycles_.begin() + static_cast<std::ptrdiff_t>(begin), cycles_.end(),
                                    [mode](const Cycle& c) { return c.steering.mode == mode; });
    EXPECT_NE(found, cycles_.end()) << Name(mode);
    return static_cast<std::size_t>(found - cycles_.begin());
  }

  // Expects that from `begin` on, while commands are enabled and the vehicle rolls, steering follows the curve without
  // a jump and never returns to straight on.
  void ExpectSteeringHeldToTheCurve(std::size_t begin) const {
    const double least = 0.5 * kWheelbase / kRadius;
    for (std::size_t i = begin; i < cycles_.size() && cycles_[i].steering.enable && cycles_[i].speed > 1.0;
         ++i) {
      EXPECT_GT(cycles_[i].steering.delta, least) << "cycle " << i;
      EXPECT_NEAR(cycles_[i].steering.delta, cycles_[i - 1].steering.delta, 0.026) << "cycle " << i;
      EXPECT_NEAR(cycles_[i].acceleration.acceleration, cycles_[i - 1].acceleration.acceleration, 1.5 + 1e-3)
          << "cycle " << i;
    }
  }

  // Expects of a permanent failure: Degraded along the rest of the last plan, then a stop along the path.
  void ExpectBridgedAndStopped(bus::ModeCause cause, bus::FaultCode fault) {
    const std::size_t degraded = First(bus::Mode::kDegraded);
    const std::size_t stop = First(bus::Mode::kSafeStop);
    ASSERT_LT(degraded, stop);
    EXPECT_EQ(cycles_[degraded - 1].steering.mode, bus::Mode::kActive);
    EXPECT_EQ(cycles_[degraded - 1].steering.plan_age, 0);
    EXPECT_EQ(cycles_[degraded].diagnostics.cause, cause);
    EXPECT_EQ(cycles_[degraded].diagnostics.previous_mode, bus::Mode::kActive);
    for (std::size_t i = degraded; i < stop; ++i) {
      EXPECT_EQ(cycles_[i].status.fault_code, fault);
      EXPECT_GT(cycles_[i].steering.plan_age, cycles_[i - 1].steering.plan_age);
      EXPECT_LT(cycles_[i].steering.plan_age, kHorizon);
      if (i > degraded) {
        EXPECT_LT(cycles_[i].diagnostics.countdown, cycles_[i - 1].diagnostics.countdown);
      }
    }
    EXPECT_EQ(cycles_[stop].diagnostics.cause, bus::ModeCause::kPlanExhausted);
    EXPECT_EQ(cycles_[stop].diagnostics.countdown, 0.0);
    ExpectSteeringHeldToTheCurve(degraded);

    const std::size_t standby = First(bus::Mode::kStandby, stop);
    EXPECT_LT(cycles_[standby].speed, 0.3);
    EXPECT_TRUE(std::all_of(cycles_.begin() + static_cast<std::ptrdiff_t>(standby), cycles_.end(),
                            [](const Cycle& c) { return !c.steering.enable && !c.acceleration.enable; }));
    EXPECT_GT(summary_["min_road_margin_m"].get<double>(), 3.0);  // of 4 m
  }

  test_support::TempDir folder_;
  bus::VehicleBus bus_;
  nlohmann::json summary_;
  std::vector<Cycle> cycles_;
};

TEST_F(FallbackInACurve, SolverThatFailsIsBridgedByThePlanAndThenTheVehicleIsStoppedOnItsPath) {
  Drive("unsolved", 100000, false);
  ExpectBridgedAndStopped(bus::ModeCause::kSolverFailed, bus::FaultCode::kSolverInfeasible);
}

TEST_F(FallbackInACurve, RejectedPlansAreBridgedByTheLastGoodOneAndThenTheVehicleIsStoppedOnItsPath) {
  Drive("rejected", 100000, false);
  ExpectBridgedAndStopped(bus::ModeCause::kPlanRejected, bus::FaultCode::kPlanRejected);
}

TEST_F(FallbackInACurve, MissedDeadlinesAreBridgedByThePlanAndThenTheVehicleIsStoppedOnItsPath) {
  Drive("late", 100000, true);
  const std::size_t stop = First(bus::Mode::kSafeStop);
  const std::size_t late = static_cast<std::size_t>(
      std::find_if(cycles_.begin(), cycles_.end(),
                   [](const Cycle& c) { return c.status.fault_code == bus::FaultCode::kDeadlineMissed; }) -
      cycles_.begin());
  ASSERT_LT(late, stop);
  EXPECT_GT(cycles_[stop].status.deadline_misses, 0);
  for (std::size_t i = late; i < stop; ++i) {
    // A command from an older plan, and no answer to the state that came too late.
    EXPECT_EQ(cycles_[i].steering.mode, bus::Mode::kDegraded);
    EXPECT_EQ(cycles_[i].steering.state_counter, 15);
    EXPECT_GT(cycles_[i].steering.plan_age, 0);
  }
  ExpectSteeringHeldToTheCurve(late);
  EXPECT_LT(cycles_.back().speed, 0.3);
  EXPECT_GT(summary_["min_road_margin_m"].get<double>(), 3.0);
}

TEST_F(FallbackInACurve, ThreeFailuresInARowAreBridgedAndTheDriveGoesOnToItsEnd) {
  Drive("unsolved", 3, false);
  const std::size_t degraded = First(bus::Mode::kDegraded);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(cycles_[degraded + i].steering.plan_age, i + 1);
  }
  EXPECT_EQ(cycles_[degraded + 3].steering.mode, bus::Mode::kActive);
  EXPECT_EQ(cycles_[degraded + 3].diagnostics.cause, bus::ModeCause::kRecovered);
  EXPECT_TRUE(summary_["completed"].get<bool>());
  EXPECT_GT(summary_["min_road_margin_m"].get<double>(), 3.0);
}

}  // namespace
}  // namespace lpvmpcd
