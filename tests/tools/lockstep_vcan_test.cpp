// The daemon and the simulated vehicle as processes on a real interface, compared with the same drive in memory.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "bus/vehicle_bus.hpp"
#include "can/candump_log.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temp_dir.hpp"

namespace {

using namespace std::chrono_literals;

const std::string kRepository = LPVMPC_SOURCE_DIR;
const std::string kScenario = kRepository + "/scenarios/whole_drive/scenario.toml";

std::vector<can::Frame> ReadLog(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<can::Frame> frames;
  for (std::string line; std::getline(in, line);) {
    const auto entry = can::ParseCandumpLine(line);
    if (!entry) throw std::runtime_error(file.string() + ": " + entry.error());
    if (*entry) frames.push_back((*entry)->frame);
  }
  return frames;
}

std::size_t Lines(const std::filesystem::path& file) {
  std::ifstream in(file);
  return static_cast<std::size_t>(
      std::count(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>(), '\n'));
}

std::vector<can::Frame> WithId(const std::vector<can::Frame>& frames, const std::set<std::uint32_t>& ids) {
  std::vector<can::Frame> selected;
  for (const can::Frame& frame : frames) {
    if (ids.contains(frame.id)) selected.push_back(frame);
  }
  return selected;
}

class LockstepOnVcan : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<test_support::TempDir>();
    const test_support::Outcome drive = test_support::Run(
        {"env", std::string("LPVMPC_BIN=") + LPVMPC_BIN_DIR, kRepository + "/scripts/drive", kScenario,
         kRepository + "/scenarios/whole_drive/lpvmpcd.toml", folder->path().string()},
        180s);
    status = drive.status;
    if (status != 0) std::fprintf(stderr, "%s%s", drive.out.c_str(), drive.err.c_str());
  }
  static void TearDownTestSuite() { folder.reset(); }

  static std::unique_ptr<test_support::TempDir> folder;
  static int status;
};

std::unique_ptr<test_support::TempDir> LockstepOnVcan::folder;
int LockstepOnVcan::status = -1;

TEST_F(LockstepOnVcan, DriveMeetsTheScenariosExpectations) {
  EXPECT_EQ(status, 0);
}

TEST_F(LockstepOnVcan, ItSetsOffFromStandstillAndStopsAtTheEndOfTheRoute) {
  const bus::VehicleBus bus;
  std::vector<double> speeds;
  bool route_end = false;
  for (const can::Frame& frame : ReadLog(folder->path() / "candump.log")) {
    const auto message = bus.Decode(frame.id, frame.Payload());
    ASSERT_TRUE(message);
    if (const auto* motion = std::get_if<bus::VehicleMotion>(&*message)) speeds.push_back(motion->upsilon);
    if (const auto* of = std::get_if<bus::ControllerStatus>(&*message)) {
      route_end = route_end || of->fault_code == bus::FaultCode::kRouteEnd;
    }
  }
  ASSERT_FALSE(speeds.empty());
  EXPECT_LT(std::abs(speeds.front()), 0.2);
  EXPECT_GT(std::ranges::max(speeds), 11.0);
  EXPECT_LT(std::abs(speeds.back()), 0.4);
  EXPECT_TRUE(route_end);
}

TEST_F(LockstepOnVcan, CommandsEqualThoseOfTheDriveInMemoryBitForBit) {
  const std::filesystem::path log = folder->path() / "memory.log";
  ASSERT_EQ(test_support::Run({LPVMPC, "run", "--scenario", kScenario, "--log", log.string()}).status, 0);
  const bus::VehicleBus bus;
  const std::set<std::uint32_t> ids{bus.Info<bus::SteeringCommand>().id,
                                    bus.Info<bus::AccelerationCommand>().id};
  std::vector<can::Frame> on_bus = WithId(ReadLog(folder->path() / "candump.log"), ids);
  const std::vector<can::Frame> in_memory = WithId(ReadLog(log), ids);
  // On the bus the daemon's last words, a pair that is not enabled, follow.
  ASSERT_EQ(on_bus.size(), in_memory.size() + 2);
  for (std::size_t i = in_memory.size(); i < on_bus.size(); ++i) {
    const auto message = bus.Decode(on_bus[i].id, on_bus[i].Payload());
    ASSERT_TRUE(message);
    std::visit(
        [](const auto& command) {
          if constexpr (requires { command.enable; }) {
            EXPECT_FALSE(command.enable);
          }
        },
        *message);
  }
  for (std::size_t i = 0; i < in_memory.size(); ++i) {
    ASSERT_TRUE(can::SameOnWire(on_bus[i], in_memory[i])) << "command frame " << i;
  }
}

TEST_F(LockstepOnVcan, DecisionsEqualThoseOfTheDriveInMemoryBitForBit) {
  const std::filesystem::path log = folder->path() / "decisions.log";
  ASSERT_EQ(test_support::Run({LPVMPC, "run", "--scenario", kScenario, "--log", log.string()}).status, 0);
  const bus::VehicleBus bus;
  const std::set<std::uint32_t> ids{bus.Info<bus::ManoeuvreStatus>().id};
  const std::vector<can::Frame> on_bus = WithId(ReadLog(folder->path() / "candump.log"), ids);
  const std::vector<can::Frame> in_memory = WithId(ReadLog(log), ids);
  ASSERT_EQ(on_bus.size(), in_memory.size());
  std::set<bus::ManoeuvreDecision> decisions;
  for (std::size_t i = 0; i < in_memory.size(); ++i) {
    ASSERT_TRUE(can::SameOnWire(on_bus[i], in_memory[i])) << "cycle " << i;
    const auto message = bus.Decode(on_bus[i].id, on_bus[i].Payload());
    decisions.insert(std::get<bus::ManoeuvreStatus>(*message).decision);
  }
  EXPECT_TRUE(decisions.contains(bus::ManoeuvreDecision::kDrive));
  EXPECT_TRUE(decisions.contains(bus::ManoeuvreDecision::kPass));
}

TEST_F(LockstepOnVcan, DaemonsLogTellsEachDecisionWithItsReason) {
  std::ifstream file(folder->path() / "lpvmpcd.log");
  const std::string log{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_THAT(log, testing::HasSubstr("drives: the way is free"));
  EXPECT_THAT(log, testing::ContainsRegex("passes object [0-9]+ on the (left|right): the way is free"));
}

TEST_F(LockstepOnVcan, SummaryTellsWhatItTellsOfTheDriveInMemory) {
  std::ifstream file(folder->path() / "summary.json");
  const nlohmann::json on_bus = nlohmann::json::parse(file);
  const nlohmann::json in_memory =
      nlohmann::json::parse(test_support::Run({LPVMPC, "run", "--scenario", kScenario, "--json"}).out);
  for (const char* figure :
       {"relaxed_steps", "rejected_plans", "min_clearance_m", "min_road_margin_m", "rms_lateral_error_m"}) {
    EXPECT_EQ(on_bus[figure], in_memory[figure]) << figure;
  }
  EXPECT_GT(in_memory["rms_lateral_error_m"], 0.0);
}

TEST_F(LockstepOnVcan, EveryFrameOnTheBusPassesItsChecks) {
  const bus::VehicleBus bus;
  std::map<std::string, int> count;
  for (const can::Frame& frame : ReadLog(folder->path() / "candump.log")) {
    ASSERT_EQ(bus.Check(frame.id, frame.Payload()).verdict, bus::E2eVerdict::kOk);
    ++count[bus.Find(frame.id)->name];
  }
  for (const bus::MessageInfo& message : bus.messages()) EXPECT_GT(count[message.name], 1000) << message.name;
}

TEST_F(LockstepOnVcan, CanplayerPlaysTheLogAgain) {
  const std::filesystem::path log = folder->path() / "beginning.log";  // the whole log would take a minute
  test_support::Run(
      {"sh", "-c", "head -n 10000 " + (folder->path() / "candump.log").string() + " >" + log.string()});
  ASSERT_EQ(Lines(log), 10000u);
  const std::filesystem::path replay = folder->path() / "replay.log";
  test_support::Process candump({"sh", "-c", "exec candump -r 67108864 -L vcan1 >" + replay.string()});
  ASSERT_TRUE(test_support::WaitUntil([&] {  // candump is listening once it shows a frame
    test_support::Run({"cansend", "vcan1", "7FF#"});
    return Lines(replay) > 0;
  }));
  const std::size_t before = Lines(replay);
  // Sizes are polled, not lines: reading the file repeatedly would keep candump from writing it.
  const std::uintmax_t size = std::filesystem::file_size(replay) + std::filesystem::file_size(log);
  const test_support::Outcome player =
      test_support::Run({"canplayer", "-t", "-I", log.string(), "vcan1=vcan0"}, 60s);
  EXPECT_EQ(player.status, 0) << player.err;
  static_cast<void>(test_support::WaitUntil([&] { return std::filesystem::file_size(replay) >= size; }, 60s));
  EXPECT_EQ(Lines(replay) - before, Lines(log));
}

TEST(DriveOnVcan, DaemonThatDidNotStartIsQuotedAndNoSummaryLeft) {
  const test_support::TempDir results;
  const test_support::Outcome drive =
      test_support::Run({"env", std::string("LPVMPC_BIN=") + LPVMPC_BIN_DIR, kRepository + "/scripts/drive",
                         kScenario, "/nowhere.toml", results.path().string()},
                        60s);
  EXPECT_NE(drive.status, 0);
  EXPECT_NE(drive.err.find("/nowhere.toml: cannot be read"), std::string::npos) << drive.err;
  EXPECT_FALSE(std::filesystem::exists(results / "summary.json"));
}

}  // namespace
