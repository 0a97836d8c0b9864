// The machine that the tests of the service run on as root: its systemd is PID 1, the package gets installed, and
// vcan0 comes and goes as a test wants it.
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

// A step that takes a tenth of a second takes many on a machine that others load.
inline constexpr std::chrono::seconds kPatience{60};

// Asks `condition` now and then until it is true, with patience. Not more often: asking systemd takes its time, and the
// machine has one processor, on which a drive goes on.
template <typename Condition>
[[nodiscard]] bool Eventually(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  return true;
}

// Runs `argv`, which has to succeed; its output.
std::string Do(const std::vector<std::string>& argv);

// A property of a unit, as systemctl show prints it; of a number, its value.
[[nodiscard]] std::string Property(const char* unit, const char* name);
[[nodiscard]] long Number(const char* unit, const char* name);

// All that the unit has said, and systemd of it, since the test began.
[[nodiscard]] std::string Journal(const char* unit);

// Waits, with patience; a failure says what was waited for.
[[nodiscard]] testing::AssertionResult Becomes(const char* unit, std::string_view state);
[[nodiscard]] testing::AssertionResult Says(const char* unit, std::string_view text);

// What the controller sends, from the beginning of its scope on.
class BusWatch {
 public:
  struct Command {
    can::Time time{};
    bus::Mode mode = bus::Mode::kInit;
    bool enable = false;
  };

  // All commands so far, steering and acceleration.
  const std::vector<Command>& Commands();
  // True as soon as the newest command is of this mode.
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

// Installs the package, once. Every test begins without an interface, with the unit enabled for it and the packaged
// configuration, but for messages that are stale later: a loaded machine may stop for some tenths of a second.
class Service : public testing::Test {
 protected:
  static void SetUpTestSuite();
  void SetUp() override;
  void TearDown() override;

  static void CreateInterface();
  static void DeleteInterface();
  // Creates the interface and waits for the daemon; the second has a vehicle drive, too, until the daemon commands it.
  static void StartDaemon();
  static void Engage(BusWatch& bus);
};

}  // namespace service_test
