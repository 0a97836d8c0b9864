// Cost of the daemon at 20 Hz in the demonstration: memory, and processor time, which the host's own kernel counts to
// the nanosecond. User-Mode Linux cannot measure processor time: its clock ticks every 10 ms, and a system call takes a
// hundred times as long as here. The bus is therefore UDP on the loopback (can_by_udp.cpp), which costs more than CAN;
// the rest of the daemon is unchanged.
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iostream>
#include <string>
#include <thread>
#include <unistd.h>

#include "tests/support/process.hpp"
#include "tests/support/temp_dir.hpp"

namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

constexpr const char* kDemonstration = LPVMPC_SOURCE_DIR "/scenarios/demo";

// Processor time [ns].
double CpuTime(pid_t pid) {
  double time = 0.0;
  std::ifstream("/proc/" + std::to_string(pid) + "/schedstat") >> time;
  return time;
}

TEST(CpuTime, DaemonAt20HzTakesLessThanAHundredthOfACoreAnd20Megabytes) {
  const test_support::TempDir folder;
  std::ofstream(folder / "scenario.toml")
      << "name = \"cost\"\nroute = \"" << kDemonstration << "/route.toml\"\nduration = 22.0\n"
      << "[[obstacle]]\nid = 1\ns = 300.0\nlateral = -0.3\nr_x = 1.0\nr_y = 1.0\nside = \"left\"\n";
  const int port = 20000 + ::getpid() % 20000;
  const auto by_udp = [port](int own, int peer, std::vector<std::string> command) {
    command.insert(command.begin(),
                   {"env", "LD_PRELOAD=" CAN_BY_UDP_LIBRARY,
                    "CAN_BY_UDP=" + std::to_string(port + own) + " " + std::to_string(port + peer)});
    return command;
  };
  test_support::Process daemon(by_udp(
      0, 1, {LPVMPCD, "--config", std::string(kDemonstration) + "/lpvmpcd.toml", "--interface", "vcan0"}));
  test_support::Process vehicle(
      by_udp(1, 0, {LPVMPC_SIM, "--interface", "vcan0", "--scenario", (folder / "scenario.toml").string()}));
  ASSERT_TRUE(test_support::WaitUntil(
      [&] { return daemon.Stderr().find("mode Standby -> Active") != std::string::npos; }, 30s))
      << daemon.Stderr() << vehicle.Stderr();

  const auto begin = steady_clock::now();
  const double used = CpuTime(daemon.pid());
  std::this_thread::sleep_for(15s);
  const double elapsed = std::chrono::duration<double, std::nano>(steady_clock::now() - begin).count();
  const double percent = 100.0 * (CpuTime(daemon.pid()) - used) / elapsed;
  const double memory =
      std::stod(test_support::ProcStatus(daemon.pid(), "VmHWM")) / 1024.0;  // peak resident memory [MB]
  std::cout << "daemon at 20 Hz in the demonstration: " << percent << " % of a core, " << memory << " MB\n";
  EXPECT_EQ(vehicle.Wait(60s), 0) << vehicle.Stderr();  // the drive was completed
  EXPECT_GT(percent, 0.0);
  EXPECT_LT(percent, 1.0);
  EXPECT_GT(memory, 0.0);
  EXPECT_LT(memory, 20.0);
}

}  // namespace
