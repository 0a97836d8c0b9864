#include "daemon/reload.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temp_dir.hpp"

namespace lpvmpcd {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::string kRoute = "[route]\nfile = \"route.toml\"\n";

class ReloadTest : public testing::Test {
 protected:
  loop::Config Load(const std::string& text) const {
    std::ofstream(folder_ / "daemon.toml") << kRoute + text;
    return loop::LoadConfig(folder_ / "daemon.toml");
  }
  std::vector<std::string> Changed(const std::string& before, const std::string& after) const {
    return ChangedKeys(Load(before), Load(after));
  }

  test_support::TempDir folder_;
};

TEST_F(ReloadTest, OnlyValuesThatDifferAreChanges) {
  EXPECT_THAT(Changed("[engage]\nmin_speed = 4.0\n[log]\nlevel = \"info\"\n",
                      "# the same in another order\n[log]\nlevel = 'info'\n\n[engage]\nmin_speed = 4.0\n"),
              IsEmpty());
  EXPECT_THAT(Changed("[engage]\nmin_speed = 4.0\n", "[engage]\nmin_speed = 5.0\n"),
              ElementsAre("engage.min_speed"));
  EXPECT_THAT(
      Changed("[controller]\nQ = [10, 10, 1, 1, 10, 1]\n", "[controller]\nQ = [10, 10, 1, 1, 10, 2]\n"),
      ElementsAre("controller.Q"));
}

TEST_F(ReloadTest, KeysWrittenAnewAndNoMoreAreChangesInAlphabeticalOrder) {
  EXPECT_THAT(Changed("[monitor]\nmax_lost = 3\n[log]\nlevel = \"info\"\n",
                      "[log]\nlevel = \"debug\"\n[engage]\nmin_speed = 5.0\n"),
              ElementsAre("engage.min_speed", "log.level", "monitor.max_lost"));
}

TEST_F(ReloadTest, WhatTheCommandLineOverridesIsNoChange) {
  loop::Config before =
      Load("[bus]\ninterface = \"can0\"\n[cycle]\nlockstep = false\n[controller]\nkind = \"lpv\"\n");
  loop::Config after = Load("[bus]\ninterface = \"can1\"\n[controller]\nkind = \"lpv-standard\"\n");
  EXPECT_EQ(ChangedKeys(before, after).size(), 3U);
  for (loop::Config* config : {&before, &after}) {
    loop::SelectInterface(*config, "vcan0");
    loop::SelectController(*config, "lpv");
    loop::SelectLockstep(*config);
  }
  EXPECT_THAT(ChangedKeys(before, after), IsEmpty());
}

TEST_F(ReloadTest, EveryKeyHasItsTime) {
  for (const char* key :
       {"engage.min_speed", "engage.max_heading_error", "safe_stop.deceleration",
        "safe_stop.standstill_speed", "monitor.stale_periods", "monitor.max_lost", "status.horizon"}) {
    EXPECT_EQ(WhyNot(key, false), "") << key;
    EXPECT_EQ(WhyNot(key, true), "cannot change while commands are enabled") << key;
  }
  EXPECT_EQ(WhyNot("log.level", true), "");
  for (const char* key : {"bus.interface", "bus.dbc", "route.file", "cycle.period", "limits.max_steering",
                          "controller.horizon", "vehicle.m", "realtime.cpus", "log.levels", "engagement"}) {
    EXPECT_EQ(WhyNot(key, false), "needs a restart") << key;
  }
}

}  // namespace
}  // namespace lpvmpcd
