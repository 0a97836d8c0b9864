// The notifier with a socket in place of systemd's.
#include "daemon/notifier.hpp"

#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/support/temp_dir.hpp"

namespace lpvmpcd {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class NotifierTest : public testing::Test {
 protected:
  NotifierTest() {
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    const std::string path = folder_ / "notify";
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  ~NotifierTest() override {
    ::close(socket_);
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
  }
  // All messages since the last call.
  std::vector<std::string> Messages() const {
    std::vector<std::string> messages;
    char text[1024];
    for (ssize_t size = 0; (size = ::recv(socket_, text, sizeof(text), MSG_DONTWAIT)) >= 0;) {
      messages.emplace_back(text, static_cast<std::size_t>(size));
    }
    return messages;
  }

  test_support::TempDir folder_;
  int socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  base::Latencies latencies_;
};

TEST_F(NotifierTest, FeedsTheWatchdogAtLeastTwiceInItsPeriodAndOnlyByCycles) {
  ::setenv("WATCHDOG_USEC", "1000000", 1);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  Notifier notifier;
  notifier.Ready();
  EXPECT_EQ(Messages(), std::vector<std::string>{"READY=1"});
  // Cycle times up to the slowest timeout that leaves room for two feeds in a watchdog period.
  for (const base::Time cycle : {base::Time(10ms), base::Time(75ms), base::Time(250ms)}) {
    base::Time last{};
    for (base::Time now = 0s; now <= 10s; now += cycle) {
      notifier.Cycle({}, latencies_, now);
      for (const std::string& text : Messages()) {
        if (text != "WATCHDOG=1") continue;
        EXPECT_LE(now - last, 500ms);
        last = now;
      }
    }
    EXPECT_GE(last, 9500ms);
    notifier = Notifier();
  }
}

TEST_F(NotifierTest, WithoutAWatchdogThereIsNothingToFeed) {
  Notifier notifier;
  notifier.Cycle({}, latencies_, 1s);
  const auto messages = Messages();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_THAT(messages.front(), StartsWith("STATUS=Init; no fault; 0 cycles"));
}

TEST_F(NotifierTest, StatusTellsLatenciesAndWhatTheKernelRefused) {
  Notifier notifier;
  latencies_.cycle.Add(2ms);
  latencies_.step.Add(1ms);
  notifier.Cycle({}, latencies_, 1s);
  EXPECT_THAT(Messages().front(), testing::AllOf(HasSubstr("latency p99 2.00 ms, max 2.00 ms"),
                                                 HasSubstr("step p99 1.00 ms"), Not(HasSubstr("real time"))));
  notifier.SetRemark("real time: refused cpu 7");
  notifier.Cycle({}, latencies_, 2s);
  EXPECT_THAT(Messages().front(), testing::EndsWith("; real time: refused cpu 7"));
}

TEST_F(NotifierTest, StatusComesAtOnceWithAChangeAndOtherwiseOnceASecond) {
  Notifier notifier;
  notifier.Cycle({}, latencies_, 1s);
  EXPECT_EQ(Messages().size(), 1U);
  notifier.Cycle({}, latencies_, 1500ms);
  EXPECT_EQ(Messages().size(), 0U);
  notifier.Cycle({.mode = bus::Mode::kStandby}, latencies_, 1600ms);
  EXPECT_EQ(Messages().size(), 1U);
  notifier.Cycle({.mode = bus::Mode::kStandby, .fault = bus::FaultCode::kOffRoute}, latencies_, 1700ms);
  EXPECT_THAT(Messages().front(), StartsWith("STATUS=Standby; not on the route or too slow"));
}

TEST_F(NotifierTest, StatusTellsThePresentDecisionAtOnceAndWhileItHolds) {
  using bus::ManoeuvreDecision, bus::ManoeuvreReason;
  Notifier notifier;
  loop::CycleReport report{.mode = bus::Mode::kActive,
                           .manoeuvre = {.decision = ManoeuvreDecision::kPass,
                                         .reason = ManoeuvreReason::kWayFree,
                                         .object_id = 3,
                                         .side = bus::PassingSide::kLeft}};
  notifier.Cycle(report, latencies_, 1s);
  EXPECT_THAT(Messages().front(),
              StartsWith("STATUS=Active; no fault; passes object 3 on the left: the way is free; 0 cycles"));
  report.manoeuvre.side = bus::PassingSide::kRight;
  for (int k = 0; k < bus::DecisionChange::kSteady; ++k) {
    EXPECT_EQ(Messages().size(), 0U);
    notifier.Cycle(report, latencies_, 1100ms);
  }
  EXPECT_THAT(Messages().at(0), HasSubstr("passes object 3 on the right"));
  report.manoeuvre = {};  // a cycle without a plan
  notifier.Cycle(report, latencies_, 1200ms);
  EXPECT_EQ(Messages().size(), 0U);
  notifier.Cycle(report, latencies_, 2200ms);
  EXPECT_THAT(Messages().at(0), HasSubstr("passes object 3"));
  notifier.Cycle({.mode = bus::Mode::kStandby}, latencies_, 2300ms);
  EXPECT_THAT(Messages().at(0), Not(HasSubstr("passes")));
}

TEST_F(NotifierTest, ReloadTellsItsTime) {
  Notifier notifier;
  notifier.Reloading();
  EXPECT_THAT(Messages().front(), testing::MatchesRegex("RELOADING=1\nMONOTONIC_USEC=[0-9]+"));
}

}  // namespace
}  // namespace lpvmpcd
