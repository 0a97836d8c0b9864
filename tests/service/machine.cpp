#include "tests/service/machine.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <iostream>
#include <iterator>

#include "tests/support/process.hpp"

namespace service_test {
namespace {

constexpr const char* kPackagedConfiguration = "/tmp/lpvmpcd.toml";
constexpr const char* kDemonstration = "/usr/share/lpvmpcd/scenarios/demo/scenario.toml";
constexpr const char* kScenario = "/usr/share/lpvmpcd/scenarios/demo/service-test.toml";

// Allows infeasible steps in the demonstration: on a loaded machine a late cycle may find its problem infeasible.
void ChooseScenario() {
  std::ifstream file(kDemonstration);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::string strict = "max_infeasible_steps = 0\n";
  ASSERT_NE(text.find(strict), std::string::npos);
  text.replace(text.find(strict), strict.size(), "max_infeasible_steps = 60\n");
  std::ofstream(kScenario) << text;
  std::ofstream("/etc/default/lpvmpc-sim") << "SCENARIO=" << kScenario << '\n';
}

std::string& Cursor() {  // place in the journal at which the test began
  static std::string cursor;
  return cursor;
}

bool InterfaceExists() {
  return std::filesystem::exists(std::string("/sys/class/net/") + kInterface);
}

}  // namespace

std::string Do(const std::vector<std::string>& argv) {
  const auto outcome = test_support::Run(argv, kPatience);
  EXPECT_EQ(outcome.status, 0) << testing::PrintToString(argv) << '\n' << outcome.out << outcome.err;
  return outcome.out;
}

std::string Property(const char* unit, const char* name) {
  std::string value = Do({"systemctl", "show", "--value", "-p", name, unit});
  if (value.ends_with('\n')) value.pop_back();
  return value;
}

long Number(const char* unit, const char* name) {
  return std::stol(Property(unit, name));
}

std::string Journal(const char* unit) {
  return Do({"journalctl", "--quiet", "--output", "cat", "--after-cursor", Cursor(), "--unit", unit});
}

testing::AssertionResult Becomes(const char* unit, std::string_view state) {
  std::string seen;
  const auto there = [&] { return (seen = Property(unit, "ActiveState")) == state; };
  if (Eventually(there)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << unit << " is " << seen << ", not " << state << ":\n" << Journal(unit);
}

testing::AssertionResult Says(const char* unit, std::string_view text) {
  std::string seen;
  const auto there = [&] { return (seen = Journal(unit)).find(text) != std::string::npos; };
  if (Eventually(there)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << unit << " does not say \"" << text << "\" but:\n" << seen;
}

const std::vector<BusWatch::Command>& BusWatch::Commands() {
  can::Received received;
  for (auto status = socket_.Receive(received); status != can::ReceiveStatus::kWouldBlock;
       status = socket_.Receive(received)) {
    if (status != can::ReceiveStatus::kFrame) continue;
    const can::Frame& frame = received.frame;
    const auto message = bus_.Decode(frame.id, frame.Payload());
    if (!message) continue;
    if (const auto* steering = std::get_if<bus::SteeringCommand>(&*message)) {
      commands_.push_back({frame.timestamp, steering->mode, steering->enable});
    } else if (const auto* acceleration = std::get_if<bus::AccelerationCommand>(&*message)) {
      commands_.push_back({frame.timestamp, acceleration->mode, acceleration->enable});
    }
  }
  return commands_;
}

testing::AssertionResult BusWatch::Reaches(bus::Mode mode) {
  const auto there = [&] { return !Commands().empty() && commands_.back().mode == mode; };
  if (test_support::WaitUntil(there, kPatience)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "no command of mode " << static_cast<int>(mode) << " among "
                                     << commands_.size() << ":\n"
                                     << Journal(kDaemon) << Journal(kVehicle);
}

can::Time Now() {
  return std::chrono::system_clock::now();
}

void Service::SetUpTestSuite() {
  if (std::filesystem::exists(kPackagedConfiguration)) return;  // done by another suite
  Do({"dpkg", "--install", LPVMPC_PACKAGE});
  EXPECT_EQ(test_support::Run({"systemctl", "is-enabled", kDaemon}).out, "disabled\n");
  EXPECT_EQ(Do({"systemctl", "list-units", "--all", "--plain", "--no-legend", "lpvmpc*"}), "");
  std::filesystem::copy_file(kConfiguration, kPackagedConfiguration);
  ChooseScenario();
  Do({"systemctl", "enable", kDaemon});
}

void Service::SetUp() {
  ASSERT_FALSE(InterfaceExists());
  std::filesystem::copy_file(kPackagedConfiguration, kConfiguration,
                             std::filesystem::copy_options::overwrite_existing);
  std::ofstream(kConfiguration, std::ios::app) << "[monitor]\nstale_periods = 20\n";
  const std::string last = Do({"journalctl", "--quiet", "--lines", "1", "--show-cursor", "--output", "cat"});
  const std::string mark = "-- cursor: ";
  const auto begin = last.rfind(mark) + mark.size();
  Cursor() = last.substr(begin, last.find('\n', begin) - begin);
}

void Service::TearDown() {
  Do({"systemctl", "stop", kVehicle, kDaemon});
  if (InterfaceExists()) DeleteInterface();
  Do({"systemctl", "reset-failed"});
  if (HasFailure()) std::cout << Journal(kDaemon) << Journal(kVehicle);
}

void Service::CreateInterface() {
  Do({"ip", "link", "add", "dev", kInterface, "type", "vcan"});
  Do({"ip", "link", "set", kInterface, "up"});
}

void Service::DeleteInterface() {
  Do({"ip", "link", "delete", kInterface});
  EXPECT_TRUE(Becomes("sys-subsystem-net-devices-vcan0.device", "inactive"));
}

void Service::StartDaemon() {
  CreateInterface();
  ASSERT_TRUE(Becomes(kDaemon, "active"));
}

void Service::Engage(BusWatch& bus) {
  Do({"systemctl", "restart", kVehicle});
  ASSERT_TRUE(bus.Reaches(bus::Mode::kActive));
}

}  // namespace service_test
