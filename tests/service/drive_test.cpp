// lpvmpcd@.service with the vehicle of lpvmpc-sim@.service: the demonstration, and drives that are broken off.
#include <algorithm>
#include <csignal>
#include <gmock/gmock.h>
#include <iostream>
#include <thread>

#include "tests/service/machine.hpp"
#include "tests/support/process.hpp"

namespace service_test {
namespace {

using namespace std::chrono_literals;
using bus::Mode;
using std::chrono::steady_clock;
using testing::HasSubstr;
using testing::StartsWith;

class Drive : public Service {
 protected:
  // Sends `signal` to the daemon, which systemd then restarts. Expects that no command after the signal is enabled
  // until the daemon is in Standby and for 1 s after.
  static void BreakOff(BusWatch& bus, int signal) {
    const long restarts = Number(kDaemon, "NRestarts");
    const long pid = Number(kDaemon, "MainPID");
    ASSERT_GT(pid, 1);
    ASSERT_EQ(::kill(static_cast<pid_t>(pid), signal), 0);
    const can::Time end = Now();
    ASSERT_TRUE(Eventually([&] { return Number(kDaemon, "NRestarts") == restarts + 1; }));
    ASSERT_TRUE(Becomes(kDaemon, "active"));
    ASSERT_TRUE(bus.Reaches(Mode::kStandby));
    std::this_thread::sleep_for(1s);

    const auto& commands = bus.Commands();
    const auto after =
        std::ranges::find_if(commands, [end](const auto& command) { return command.time > end; });
    EXPECT_TRUE(std::any_of(commands.begin(), after, [](const auto& command) { return command.enable; }));
    EXPECT_GT(commands.end() - after, 20);
    EXPECT_TRUE(std::none_of(after, commands.end(), [](const auto& command) { return command.enable; }));
  }
};

TEST_F(Drive, DemonstrationMeetsItsExpectationsWithLittleMemory) {
  StartDaemon();
  BusWatch bus;
  Engage(bus);
  EXPECT_TRUE(Eventually([] { return Property(kDaemon, "StatusText").starts_with("Active; no fault; "); }));
  const auto begin = steady_clock::now();
  const long used = Number(kDaemon, "CPUUsageNSec");
  std::this_thread::sleep_for(50s);  // the drive takes 60 s
  const double percent = 100.0 * static_cast<double>(Number(kDaemon, "CPUUsageNSec") - used) /
                         std::chrono::duration<double, std::nano>(steady_clock::now() - begin).count();
  ASSERT_TRUE(Becomes(kVehicle, "inactive"));  // the drive has ended by itself
  EXPECT_EQ(Property(kVehicle, "Result"), "success") << Journal(kVehicle);
  EXPECT_EQ(Property(kDaemon, "NRestarts"), "0");

  // The kernel of User-Mode Linux counts by its tick of 10 ms, and a system call takes 100 times as long as on a native
  // kernel, so the share of the processor is only printed and has no limit. A cycle that a tick starts is over before
  // the next one: the share may be 0, and only the daemon's start is certain to have been counted.
  const auto pid = static_cast<pid_t>(Number(kDaemon, "MainPID"));
  const double memory =
      std::stod(test_support::ProcStatus(pid, "VmHWM")) / 1024.0;  // peak resident memory [MB]
  std::cout << "daemon at 20 Hz in the demonstration: " << percent << " % of this processor, " << memory
            << " MB\n";
  EXPECT_GT(used, 0);
  EXPECT_LT(memory, 20.0);
}

TEST_F(Drive, KilledAtAnyMomentItComesBackAndCommandsNothingUntilAskedAnew) {
  StartDaemon();
  BusWatch bus;
  for (const auto moment : {0ms, 700ms, 5000ms}) {
    ASSERT_NO_FATAL_FAILURE(Engage(bus));
    std::this_thread::sleep_for(moment);
    ASSERT_NO_FATAL_FAILURE(BreakOff(bus, SIGKILL));
  }
  Engage(bus);
}

TEST_F(Drive, HangingItIsKilledByTheWatchdogAndCommandsNothingUntilAskedAnew) {
  StartDaemon();
  BusWatch bus;
  ASSERT_NO_FATAL_FAILURE(Engage(bus));
  BreakOff(bus, SIGSTOP);
  EXPECT_TRUE(Says(kDaemon, "Watchdog timeout"));
  Engage(bus);
}

TEST_F(Drive, CleanStopSendsDisabledCommandsLast) {
  StartDaemon();
  BusWatch bus;
  ASSERT_NO_FATAL_FAILURE(Engage(bus));
  Do({"systemctl", "stop", kDaemon});
  EXPECT_EQ(Property(kDaemon, "Result"), "success");
  const auto& commands = bus.Commands();
  ASSERT_GE(commands.size(), 4U);
  for (auto last = commands.end() - 2; last != commands.end(); ++last) EXPECT_FALSE(last->enable);
  EXPECT_TRUE((commands.end() - 3)->enable);
}

TEST_F(Drive, LinkDownEndsIt) {
  StartDaemon();
  BusWatch bus;
  ASSERT_NO_FATAL_FAILURE(Engage(bus));
  Do({"ip", "link", "set", kInterface, "down"});
  EXPECT_TRUE(Says(kDaemon, "mode Active -> SafeStop: bus down"));
  Do({"ip", "link", "set", kInterface, "up"});
  EXPECT_TRUE(Says(kDaemon, "vcan0 is up"));
  EXPECT_EQ(Property(kDaemon, "NRestarts"), "0");
}

}  // namespace
}  // namespace service_test
