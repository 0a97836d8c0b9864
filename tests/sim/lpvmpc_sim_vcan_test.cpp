// lpvmpc-sim as a process on a real vcan0, against a stand-in for the controller.
#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "can/socket.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/sim/fake_daemon.hpp"
#include "tests/sim/scenario_files.hpp"
#include "tests/support/process.hpp"

namespace sim {
namespace {

using namespace std::chrono_literals;
using test_support::Outcome;
using test_support::Process;
using testing::HasSubstr;

const std::string kSim = LPVMPC_SIM;

// Answers on vcan0 until it is destroyed; sends its status every 50 ms while nothing arrives.
class ControllerOnBus {
 public:
  explicit ControllerOnBus(const Scenario& scenario) : controller_(bus_, scenario.route), socket_("vcan0") {
    thread_ = std::thread([this] { Run(); });
  }
  ~ControllerOnBus() {
    stop_ = true;
    thread_.join();
  }
  std::atomic<bool> mute = false;  // receives, but no longer answers
  std::atomic<int> frames_sent = 0;

 private:
  void Run() {
    can::Received received;
    while (!stop_) {
      if (!can::WaitReadable(socket_.fd(), 50ms)) Send({controller_.Status()});
      while (socket_.Receive(received) == can::ReceiveStatus::kFrame)
        Send(controller_.Receive(received.frame));
    }
  }
  void Send(const std::vector<can::Frame>& frames) {
    if (mute) return;
    for (const can::Frame& frame : frames) EXPECT_EQ(socket_.Send(frame), can::SendStatus::kSent);
    frames_sent += static_cast<int>(frames.size());
  }

  bus::VehicleBus bus_;
  FakeDaemon controller_;
  can::Socket socket_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

class LpvmpcSim : public testing::Test {
 protected:
  std::vector<std::string> Command(const std::string& text, const std::vector<std::string>& more) {
    scenario_.emplace(files_.Load(text));
    std::vector<std::string> argv{kSim, "--interface", "vcan0", "--scenario",
                                  (files_.folder() / "scenario.toml").string()};
    argv.insert(argv.end(), more.begin(), more.end());
    return argv;
  }

  ScenarioFiles files_;
  std::optional<Scenario> scenario_;
};

TEST_F(LpvmpcSim, LockStepDrivesToTheEndFasterThanRealTime) {
  const auto argv = Command("", {"--lockstep", "--json"});
  const ControllerOnBus controller(*scenario_);
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = test_support::Run(argv);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);  // the drive lasts 13 s
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["completed"], true);
  EXPECT_EQ(json["passed"], true);
  EXPECT_GT(json["steps"], 250);
}

TEST_F(LpvmpcSim, LockStepIsRepeatable) {
  const auto argv =
      Command("duration = 5.0\nseed = 3\n[sensors]\nposition = 0.05\n", {"--lockstep", "--json"});
  std::vector<std::string> results;
  for (int i = 0; i < 2; ++i) {
    const ControllerOnBus controller(*scenario_);
    auto json = nlohmann::json::parse(test_support::Run(argv).out);
    json.erase("solve_time_us");
    results.push_back(json.dump());
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST_F(LpvmpcSim, PacedDriveTakesItsTime) {
  const auto argv = Command("duration = 2.0\n", {});
  const ControllerOnBus controller(*scenario_);
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = test_support::Run(argv);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 1900ms);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("passed"));
}

TEST_F(LpvmpcSim, ExpectationThatIsNotMetGivesExitOne) {
  const auto argv = Command("duration = 3.0\n[expect]\nmin_road_margin_m = 3.9\n", {"--lockstep"});
  const ControllerOnBus controller(*scenario_);
  const Outcome outcome = test_support::Run(argv);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("FAILED: min_road_margin_m"));
}

TEST_F(LpvmpcSim, WithoutAControllerEndsAfterTheTimeout) {
  const Outcome outcome = test_support::Run(Command("", {"--lockstep", "--timeout", "0.5"}));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, "lpvmpc-sim: vcan0: no controller: no ControllerStatus within 0.5 s\n");
}

TEST_F(LpvmpcSim, LockStepWithoutAnAnswerEndsWithAnError) {
  const auto argv = Command("duration = 1000.0\n", {"--lockstep"});
  ControllerOnBus controller(*scenario_);
  Process process(argv);
  ASSERT_TRUE(test_support::WaitUntil([&] { return controller.frames_sent > 300; }));
  controller.mute = true;
  EXPECT_EQ(process.Wait(20s), 1);
  EXPECT_THAT(process.Stderr(), HasSubstr("no answer to the state at"));
}

TEST_F(LpvmpcSim, SignalEndsTheDriveWithItsSummary) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto argv = Command("duration = 1000.0\n", {"--json"});
    const ControllerOnBus controller(*scenario_);
    Process process(argv);
    ASSERT_TRUE(test_support::WaitUntil([&] { return controller.frames_sent > 60; }));
    process.Signal(signal);
    EXPECT_EQ(process.Wait(10s), 1);  // not completed
    EXPECT_EQ(nlohmann::json::parse(process.Stdout())["completed"], false);
  }
}

TEST_F(LpvmpcSim, BadInputIsOneLineAndExitTwo) {
  const std::string good = Command("", {})[4];
  const std::string outside = (files_.folder() / "outside.toml").string();
  files_.Write(
      "outside.toml",
      "name = \"a\"\nroute = \"route.toml\"\n[[obstacle]]\nid = 1\nX = 1700\nY = 0\nr_x = 1\nr_y = 1\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{kSim}, "--interface"},
      {{kSim, "--interface", "vcan0", "--scenario", good, "--bogus"}, "--bogus"},
      {{kSim, "--interface", "vcan0", "--scenario", good, "--timeout", "soon"}, "--timeout"},
      {{kSim, "--interface", "vcan0", "--scenario", good, "--timeout", "nan"}, "--timeout: nan is outside"},
      {{kSim, "--interface", "vcan0", "--scenario", "/nowhere.toml"}, "/nowhere.toml: cannot be read"},
      {{kSim, "--interface", "vcan0", "--scenario", outside},
       "outside.toml:5: key 'obstacle[0].X' = 1700 is outside"},
      {{kSim, "--interface", "nocan0", "--scenario", good}, "nocan0"},
  };
  for (const auto& [argv, text] : cases) {
    const Outcome outcome = test_support::Run(argv);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(text));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST_F(LpvmpcSim, HelpIsExitZero) {
  EXPECT_EQ(test_support::Run({kSim, "--help"}).status, 0);
}

}  // namespace
}  // namespace sim
