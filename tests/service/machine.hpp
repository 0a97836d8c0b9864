// The machine on which the tests of the service run as root: its PID 1 is systemd, the package is installed, and the
// tests create and delete vcan0.
#pragma once

#include <chrono>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/socket.hpp"

namespace service_test {

inline constexpr const char* kInterface = "vcan0";
inline constexpr const char* kDaemon = "lpvmpcd@vcan0.service";
inline constexpr const char* kVehicle = "lpvmpc-sim@vcan0.service";
inline constexpr const char* kConfiguration = "/etc/lpvmpcd/lpvmpcd.toml";

// Time limit of one step: on a loaded machine a step of 0.1 s may take seconds.
inline constexpr std::chrono::seconds kPatience{60};

// Polls `condition` every 200 ms until it is true; false after kPatience. Polling systemd is slow, and the machine has
// one processor, which the drive needs as well.
template <typename Condition>
[[nodiscard]] bool Eventually(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  return true;
}

// Runs `argv`, which must succeed, and returns its output.
std::string Do(const std::vector<std::string>& argv);

// A property of a unit as systemctl show prints it, and as a number.
[[nodiscard]] std::string Property(const char* unit, const char* name);
[[nodiscard]] long Number(const char* unit, const char* name);

// All lines of the unit, and of systemd about it, since the test began.
[[nodiscard]] std::string Journal(const char* unit);

// Waits up to kPatience; a failure names the unit and what was expected of it.
[[nodiscard]] testing::AssertionResult Becomes(const char* unit, std::string_view state);
[[nodiscard]] testing::AssertionResult Says(const char* unit, std::string_view text);

// Records the controller's commands from its construction on.
class BusWatch {
 public:
  struct Command {
    can::Time time{};
    bus::Mode mode = bus::Mode::kInit;
    bool enable = false;
  };

  // All commands so far, steering and acceleration.
  const std::vector<Command>& Commands();
  // Waits until the newest command is in `mode`.
  [[nodiscard]] testing::AssertionResult Reaches(bus::Mode mode);

 private:
  bus::VehicleBus bus_;
  can::Socket socket_{kInterface,
                      {.filters = {Filter<bus::SteeringCommand>(), Filter<bus::AccelerationCommand>()}}};
  std::vector<Command> commands_;

  template <typename Command>
  [[nodiscard]] can::Filter Filter() const {
    return can::ExactStandardId(bus_.Info<Command>().id);
  }
};

// The wall clock, which stamps frames.
[[nodiscard]] can::Time Now();

// Installs the package once. Every test begins without an interface, with the unit enabled for it and the packaged
// configuration, except that messages become stale later: a loaded machine may pause for some tenths of a second.
class Service : public testing::Test {
 protected:
  static void SetUpTestSuite();
  void SetUp() override;
  void TearDown() override;

  static void CreateInterface();
  static void DeleteInterface();
  // StartDaemon creates the interface and waits for the daemon; Engage starts a vehicle and waits for Active.
  static void StartDaemon();
  static void Engage(BusWatch& bus);
};

}  // namespace service_test
