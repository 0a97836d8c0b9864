// Bad input yields one clear line on stderr and a non-zero status.
#include <algorithm>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/daemon_on_bus.hpp"

namespace lpvmpcd {
namespace {

using test_support::Outcome;
using testing::HasSubstr;
using testing::StartsWith;

class DaemonBadInput : public testing::Test {
 protected:
  DaemonBadInput() {
    std::ofstream(folder_ / "route.toml") << kStraightRoute;
    config_ = Write("daemon.toml", "[route]\nfile = \"route.toml\"\n");
  }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  static Outcome Daemon(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), LPVMPCD);
    return test_support::Run(arguments);
  }
  // The one line on stderr of a start that is refused with `status`.
  static std::string Refused(const std::vector<std::string>& arguments, int status) {
    const Outcome outcome = Daemon(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, StartsWith("lpvmpcd: "));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    return outcome.err;
  }

  test_support::TempDir folder_;
  std::string config_;
};

TEST_F(DaemonBadInput, UnknownOption) {
  EXPECT_THAT(Refused({"--config", config_, "--colour"}, 2), HasSubstr("--colour"));
  EXPECT_THAT(Refused({}, 2), HasSubstr("--config"));
  EXPECT_THAT(Refused({"--config", config_, "--controller", "pid"}, 2), HasSubstr("pid"));
}

TEST_F(DaemonBadInput, MissingFile) {
  EXPECT_THAT(Refused({"--config", "/nowhere/daemon.toml"}, 2), HasSubstr("/nowhere/daemon.toml"));
  const std::string config = Write("other.toml", "[route]\nfile = \"none.toml\"\n");
  EXPECT_THAT(Refused({"--config", config}, 2), HasSubstr("none.toml"));
}

TEST_F(DaemonBadInput, WrongTomlTypeNamesFileLineKeyAndValue) {
  const std::string config =
      Write("other.toml", "[route]\nfile = \"route.toml\"\n[controller]\nhorizon = \"long\"\n");
  const std::string error = Refused({"--config", config}, 2);
  EXPECT_THAT(error, HasSubstr("other.toml:4: "));
  EXPECT_THAT(error, HasSubstr("horizon"));
  EXPECT_THAT(error, HasSubstr("long"));
}

TEST_F(DaemonBadInput, DbcSyntaxErrorNamesFileAndLine) {
  Write("wrong.dbc", "VERSION \"1\"\n\nBO_ 256 VehiclePose 8 Vehicle\n");
  const std::string config =
      Write("other.toml", "[bus]\ndbc = \"wrong.dbc\"\n[route]\nfile = \"route.toml\"\n");
  EXPECT_THAT(Refused({"--config", config}, 2), HasSubstr("wrong.dbc:3:"));
}

TEST_F(DaemonBadInput, InterfaceThatDoesNotExist) {
  EXPECT_THAT(Refused({"--config", config_, "--interface", "can77"}, 1), HasSubstr("can77"));
  EXPECT_THAT(Refused({"--config", config_, "--interface", "lo"}, 1), HasSubstr("lo"));
}

TEST_F(DaemonBadInput, CheckConfigSaysWhatItWouldRun) {
  Outcome outcome =
      Daemon({"--config", config_, "--interface", "can77", "--controller", "lpv-standard", "--check-config"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("can77"));
  EXPECT_THAT(outcome.out, HasSubstr("lpv-standard"));
  outcome = Daemon({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, StartsWith("lpvmpcd "));
}

}  // namespace
}  // namespace lpvmpcd
