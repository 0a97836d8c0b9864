// lpvmpcd@.service without a drive: how it starts, fails and ends.
#include <fstream>
#include <gmock/gmock.h>
#include <iostream>
#include <sched.h>

#include "tests/service/machine.hpp"
#include "tests/support/process.hpp"

namespace service_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class Unit : public Service {};

TEST_F(Unit, StartsWhenTheInterfaceAppearsAndTellsItsState) {
  EXPECT_EQ(Property(kDaemon, "ActiveState"), "inactive");
  StartDaemon();
  EXPECT_TRUE(Says(kDaemon, "listening on vcan0"));
  EXPECT_TRUE(Eventually([] { return !Property(kDaemon, "StatusText").empty(); }));
  EXPECT_THAT(Property(kDaemon, "StatusText"), StartsWith("Init; "));
  EXPECT_THAT(Property(kDaemon, "StatusText"), HasSubstr(" cycles, 0 deadline misses"));
}

TEST_F(Unit, FollowsAnInterfaceThatComesAndGoes) {
  for (int i = 0; i < 2; ++i) {
    StartDaemon();
    DeleteInterface();
    ASSERT_TRUE(Becomes(kDaemon, "inactive"));
  }
  EXPECT_EQ(Property(kDaemon, "StartLimitIntervalUSec"), "0");  // no limit on the number of starts
}

TEST_F(Unit, LivesThroughALinkThatGoesDownAndUp) {
  StartDaemon();
  const std::string pid = Property(kDaemon, "MainPID");
  Do({"ip", "link", "set", kInterface, "down"});
  EXPECT_TRUE(Says(kDaemon, "vcan0 is down"));
  Do({"ip", "link", "set", kInterface, "up"});
  EXPECT_TRUE(Says(kDaemon, "vcan0 is up"));
  EXPECT_EQ(Property(kDaemon, "ActiveState"), "active");
  EXPECT_EQ(Property(kDaemon, "MainPID"), pid);
}

TEST_F(Unit, FailsAtOnceWithTheReasonWhereTheConfigurationIsWrong) {
  std::ofstream(kConfiguration) << "[route]\nfile = \"route.toml\"\n[controller]\nhorizon = -3\n";
  CreateInterface();
  ASSERT_TRUE(Becomes(kDaemon, "failed"));
  EXPECT_TRUE(
      Says(kDaemon, "/etc/lpvmpcd/lpvmpcd.toml:4: key 'controller.horizon' = -3 is outside [2, 100]"));
  EXPECT_EQ(Property(kDaemon, "NRestarts"), "0");
  EXPECT_EQ(Property(kDaemon, "ExecMainStatus"), "2");
}

TEST_F(Unit, ReloadsItsConfiguration) {
  StartDaemon();
  const std::string pid = Property(kDaemon, "MainPID");
  Do({"systemctl", "reload", kDaemon});
  EXPECT_TRUE(Says(kDaemon, "configuration reloaded"));
  EXPECT_EQ(Property(kDaemon, "MainPID"), pid);
}

TEST_F(Unit, IsExposedNoMoreThanItHasToBe) {
  StartDaemon();
  const std::string lines = Do({"systemd-analyze", "security", "--no-pager", kDaemon});
  const std::string mark = std::string("Overall exposure level for ") + kDaemon + ": ";
  ASSERT_THAT(lines, HasSubstr(mark));
  const double exposure = std::stod(lines.substr(lines.find(mark) + mark.size()));
  std::cout << "systemd-analyze security: exposure " << exposure << '\n';
  EXPECT_LE(exposure, 1.4) << lines;
  EXPECT_GT(exposure, 0.0);
}

TEST_F(Unit, RunsAsAUserOfItsOwnWithoutPrivileges) {
  StartDaemon();
  const std::string status = Do({"cat", "/proc/" + Property(kDaemon, "MainPID") + "/status"});
  EXPECT_THAT(status, HasSubstr("NoNewPrivs:\t1\n"));
  EXPECT_THAT(status, HasSubstr("CapEff:\t0000000000000000\n"));
  EXPECT_THAT(status, testing::Not(HasSubstr("Uid:\t0\t")));
}

TEST_F(Unit, IsGrantedTheRealTimeThatItsConfigurationAsksFor) {
  StartDaemon();
  EXPECT_TRUE(Says(kDaemon, "real time: "));
  const auto pid = static_cast<pid_t>(Number(kDaemon, "MainPID"));
  EXPECT_EQ(::sched_getscheduler(pid) & ~SCHED_RESET_ON_FORK, SCHED_FIFO);
  EXPECT_GT(std::stol(test_support::ProcStatus(pid, "VmLck")), 0);
  EXPECT_THAT(Property(kDaemon, "StatusText"), testing::Not(HasSubstr("refused")));
}

}  // namespace
}  // namespace service_test
