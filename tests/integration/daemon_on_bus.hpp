// The real lpvmpcd on a real CAN interface, with a scripted vehicle on a straight route at 10 m/s as its peer.
#pragma once

#include <chrono>
#include <csignal>
#include <fstream>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/socket.hpp"
#include "safety/mode_machine.hpp"
#include "tests/bus/bus_frames.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temp_dir.hpp"

namespace lpvmpcd {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

inline constexpr const char* kStraightRoute =
    "[route]\nstart = {X = 0.0, Y = 0.0, psi = 0.0}\nspeed = 10.0\n"
    "pieces = [{kind = \"straight\", length = 1000.0}]\n[road]\nleft = 4.0\nright = 4.0\n";

struct CommandPair {
  bus::SteeringCommand steering;
  bus::AccelerationCommand acceleration;
};

class DaemonOnBus : public testing::Test {
 protected:
  explicit DaemonOnBus(std::string interface = "vcan0") : interface_(std::move(interface)) {
    std::ofstream(folder_ / "route.toml") << kStraightRoute;
    // A loaded machine may pause for some tenths of a second: messages become stale later, and plans are longer.
    std::ofstream(folder_ / "daemon.toml") << "[route]\nfile = \"route.toml\"\n[monitor]\nstale_periods = 8\n"
                                              "[controller]\nhorizon = 20\n";
  }

  void StartDaemon() {
    daemon_.emplace(std::vector<std::string>{LPVMPCD, "--config", (folder_ / "daemon.toml").string(),
                                             "--interface", interface_});
    ASSERT_TRUE(LogSays("listening on " + interface_));
  }
  bool LogSays(const std::string& text) {
    return test_support::WaitUntil([&] { return daemon_->Stderr().find(text) != std::string::npos; });
  }

  void Put(const std::vector<can::Frame>& frames) {
    for (const can::Frame& frame : frames) {
      EXPECT_EQ(socket_.Send(frame), can::SendStatus::kSent);
    }
  }

  // Reads the next pair of commands; nothing if none arrives in time. Expects of every pair: CRC, counters in sequence,
  // both commands alike, enabled only in Active, Degraded and SafeStop. Stores the latest status.
  std::optional<CommandPair> NextPair(std::chrono::milliseconds timeout = 2s) {
    const auto end = steady_clock::now() + timeout;
    can::Received received;
    for (;;) {
      if (socket_.Receive(received) != can::ReceiveStatus::kFrame) {
        if (steady_clock::now() >= end) return std::nullopt;
        static_cast<void>(can::WaitReadable(socket_.fd(), std::min(timeout, 20ms)));
        continue;
      }
      const can::Frame& frame = received.frame;
      const auto message = bus_.Decode(frame.id, frame.Payload());
      if (!message) {
        ADD_FAILURE() << "a frame of another sender: " << frame.id;
        continue;
      }
      const bus::E2eCheck check = bus_.Check(frame.id, frame.Payload());
      if (const auto* status = std::get_if<bus::ControllerStatus>(&*message)) {
        EXPECT_EQ(check.verdict, bus::E2eVerdict::kOk);
        status_ = *status;
      } else if (const auto* steering = std::get_if<bus::SteeringCommand>(&*message)) {
        EXPECT_EQ(check.verdict, bus::E2eVerdict::kOk);
        if (command_counter_) {
          EXPECT_EQ(check.counter, dbc::NextCounter(*command_counter_));
        }
        command_counter_ = check.counter;
        pair_.steering = *steering;
      } else if (const auto* acceleration = std::get_if<bus::AccelerationCommand>(&*message)) {
        EXPECT_EQ(check.verdict, bus::E2eVerdict::kOk);
        EXPECT_EQ(check.counter, command_counter_);
        pair_.acceleration = *acceleration;
        const bool enable = bus::Commands(pair_.steering.mode);
        EXPECT_EQ(pair_.steering.enable, enable);
        EXPECT_EQ(pair_.acceleration.enable, enable);
        EXPECT_EQ(pair_.acceleration.mode, pair_.steering.mode);
        EXPECT_EQ(pair_.acceleration.state_counter, pair_.steering.state_counter);
        return pair_;
      }
    }
  }

  // Discards the frames so far and forgets the counters.
  void Forget() {
    can::Received ignored;
    while (socket_.Receive(ignored) != can::ReceiveStatus::kWouldBlock) {
    }
    command_counter_.reset();
  }

  // The pair that answers the state set sent last; earlier pairs, sent by the timer, are skipped.
  CommandPair Answer() {
    while (const auto pair = NextPair()) {
      if (pair->steering.state_counter == vehicle_.last_state_counter()) return *pair;
      EXPECT_EQ(pair->steering.state_counter, 15);
    }
    ADD_FAILURE() << "no answer to state " << int{vehicle_.last_state_counter()} << "; the daemon says:\n"
                  << daemon_->Stderr();
    return {};
  }
  // One complete period, as fast as the daemon answers.
  CommandPair Period() {
    vehicle_.pose.X += 0.5;
    Put(vehicle_.All());
    return Answer();
  }
  // One period in real time without a usable state: `instead` is sent in its place.
  void PeriodWithoutState(const std::vector<can::Frame>& instead) {
    vehicle_.pose.X += 0.5;
    Put(vehicle_.Request());
    Put(vehicle_.Obstacles());
    Put(instead);
    std::this_thread::sleep_for(50ms);
  }
  // Sends periods in real time, with the result of `state` in place of the state, until a pair in SafeStop arrives.
  // Returns the pairs up to that one.
  template <typename State>
  std::vector<CommandPair> UntilSafeStop(State state) {
    std::vector<CommandPair> pairs;
    for (int i = 0; i < 40; ++i) {
      PeriodWithoutState(state());
      while (const auto pair = NextPair(1ms)) {
        pairs.push_back(*pair);
        if (pair->steering.mode == bus::Mode::kSafeStop) return pairs;
      }
    }
    ADD_FAILURE() << "no SafeStop; the daemon says:\n" << daemon_->Stderr();
    return pairs;
  }
  // Brings the daemon from its start to Active.
  void Engage() {
    vehicle_.request.engage = false;
    for (int i = 0; i < 50 && Period().steering.mode != bus::Mode::kStandby; ++i) {
    }
    Period();
    vehicle_.request.engage = true;
    const CommandPair pair = Period();
    ASSERT_EQ(pair.steering.mode, bus::Mode::kActive) << daemon_->Stderr();
  }
  // The fault in the status, which follows its commands.
  bus::FaultCode Fault() {
    const auto end = steady_clock::now() + 300ms;
    while (steady_clock::now() < end && !NextPair(10ms)) {
    }
    return status_.fault_code;
  }

  std::string interface_;
  test_support::TempDir folder_;
  bus::VehicleBus bus_;
  bus::FakeVehicle vehicle_{bus_};
  can::Socket socket_{interface_};
  std::optional<test_support::Process> daemon_;
  std::optional<std::uint8_t> command_counter_;
  CommandPair pair_;  // being received
  bus::ControllerStatus status_;
};

}  // namespace lpvmpcd
