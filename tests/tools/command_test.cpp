// The three programs at their command lines: what goes wrong is one clear line on stderr and a status that is not 0.
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "tests/support/process.hpp"
#include "tests/support/temp_dir.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kDemo = LPVMPC_SOURCE_DIR "/scenarios/demo";

void ExpectOneLine(const std::vector<std::string>& argv, const testing::Matcher<std::string>& line) {
  const test_support::Outcome outcome = test_support::Run(argv);
  EXPECT_NE(outcome.status, 0) << argv[0];
  EXPECT_LT(outcome.status, 128) << "ended by a signal";
  EXPECT_THAT(outcome.err, line);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

std::string Write(const test_support::TempDir& folder, const std::string& name, const std::string& text) {
  const std::string file = (folder.path() / name).string();
  std::ofstream(file) << text;
  return file;
}

TEST(Lpvmpc, UnknownOptionIsNamed) {
  ExpectOneLine({LPVMPC, "run", "--scenari", "x"}, AllOf(StartsWith("lpvmpc: "), HasSubstr("--scenari")));
}

TEST(Lpvmpc, UnknownOptionIsNotHiddenByWhatElseIsMissing) {
  ExpectOneLine({LPVMPC, "--bogus"}, HasSubstr("--bogus"));
  ExpectOneLine({LPVMPC, "run", "--bogus"}, HasSubstr("--bogus"));
  ExpectOneLine({LPVMPC, "bench", "--bogus"}, HasSubstr("--bogus"));
}

TEST(Lpvmpc, WhatIsRequiredIsNamed) {
  ExpectOneLine({LPVMPC}, HasSubstr("run, decode, bench, paper or report"));
  ExpectOneLine({LPVMPC, "bench"}, HasSubstr("bench step"));
  ExpectOneLine({LPVMPC, "run"}, HasSubstr("--scenario"));
  ExpectOneLine({LPVMPC, "report", "-o", "x.html"}, HasSubstr("RUN_DIR"));
  ExpectOneLine({LPVMPC, "report", "x"}, HasSubstr("--output"));
}

TEST(Lpvmpc, FolderOfARunThatHoldsNoneIsNamed) {
  const test_support::TempDir folder;
  const std::string page = (folder.path() / "page.html").string();
  ExpectOneLine({LPVMPC, "report", folder.path().string(), "-o", page}, HasSubstr("drive.toml"));
  EXPECT_FALSE(std::filesystem::exists(page));
}

TEST(Lpvmpc, FolderThatCannotBeWrittenIsNamedBeforeAnythingIsDriven) {
  const test_support::TempDir folder;
  const std::string file = Write(folder, "file", "precious\n");
  ExpectOneLine({LPVMPC, "paper", "--out", file}, HasSubstr(file));
  ExpectOneLine({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--out", file}, HasSubstr(file));
  EXPECT_EQ(std::filesystem::file_size(file), 9u);
}

TEST(Lpvmpc, PapersScenariosThatAreMissingAreNamed) {
  ExpectOneLine({LPVMPC, "paper", "--scenarios", "/nowhere"}, HasSubstr("/nowhere/feasibility/01.toml"));
  ExpectOneLine({LPVMPC, "paper", "--repeat", "0"}, HasSubstr("--repeat"));
}

TEST(Lpvmpc, RunLeavesAFolderThatReportTakes) {
  const test_support::TempDir folder;
  const std::string run = (folder.path() / "run").string(), page = (folder.path() / "page.html").string();
  EXPECT_EQ(test_support::Run({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--out", run}).status,
            0);
  const test_support::Outcome outcome = test_support::Run({LPVMPC, "report", run, "-o", page});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_GT(std::filesystem::file_size(page), 100'000u);
  ExpectOneLine({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--out", run, "--log", page},
                HasSubstr("--log"));
}

TEST(Lpvmpc, MissingScenarioIsNamed) {
  ExpectOneLine({LPVMPC, "run", "--scenario", "/nowhere/s.toml"}, HasSubstr("/nowhere/s.toml"));
}

TEST(Lpvmpc, MissingLogIsNamed) {
  ExpectOneLine({LPVMPC, "decode", "/nowhere.log"}, HasSubstr("/nowhere.log"));
}

TEST(Lpvmpc, UnknownControllerIsNamed) {
  ExpectOneLine({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--controller", "pid"},
                AllOf(HasSubstr("pid"), HasSubstr("lpv-standard")));
}

TEST(Lpvmpc, ObstacleOutsideTheMapIsNamedWithFileLineKeyValueAndRange) {
  const test_support::TempDir folder;
  const std::string file =
      Write(folder, "s.toml",
            "name = \"x\"\nroute = \"" + kDemo + "/route.toml\"\n" +
                "[[obstacle]]\nid = 1\nX = 5000.0\nY = 0.0\nr_x = 1.0\nr_y = 1.0\nside = \"left\"\n");
  ExpectOneLine({LPVMPC, "run", "--scenario", file},
                AllOf(HasSubstr(file + ":5:"), HasSubstr("X"), HasSubstr("5000"), HasSubstr("1500")));
}

TEST(Lpvmpc, LogThatCannotBeWrittenIsNamed) {
  ExpectOneLine({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--log", "/nowhere/out.log"},
                HasSubstr("/nowhere/out.log"));
}

TEST(Lpvmpc, LogIsNotTouchedByARunThatCannotBegin) {
  const test_support::TempDir folder;
  const std::string log = Write(folder, "old.log", "precious\n");
  const std::string config = Write(folder, "c.toml", "[route]\nfile = \"none.toml\"\n");
  ExpectOneLine({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--config", config, "--log", log},
                HasSubstr("none.toml"));
  EXPECT_EQ(std::filesystem::file_size(log), 9u);
}

TEST(Lpvmpc, OutputThatCannotBeWrittenIsToldAndIsNoSuccess) {
  for (const std::string& command :
       {std::string(" run --scenario ") + kDemo + "/scenario.toml", std::string(" --help"),
        std::string(" bench step --horizon 8 --repeat 1")}) {
    ExpectOneLine({"sh", "-c", LPVMPC + command + " >/dev/full"}, HasSubstr("standard output"));
  }
}

TEST(Lpvmpc, InputThatCannotBeReadIsToldAndIsNoSuccess) {
  ExpectOneLine({"sh", "-c", LPVMPC " decode </tmp"}, HasSubstr("standard input"));
  ExpectOneLine({LPVMPC, "decode", "/tmp"}, HasSubstr("/tmp: cannot be read: Is a directory"));
}

TEST(Lpvmpc, PeriodThatIsNotTheVehiclesIsNamed) {
  const test_support::TempDir folder;
  const std::string config =
      Write(folder, "c.toml", "[route]\nfile = \"" + kDemo + "/route.toml\"\n[cycle]\nperiod = 0.02\n");
  ExpectOneLine({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--config", config},
                AllOf(HasSubstr("cycle.period = 0.02"), HasSubstr("0.05")));
}

TEST(Lpvmpc, HorizonOutsideTheRouteIsNamedBeforeAnythingIsPrinted) {
  ExpectOneLine({LPVMPC, "bench", "step", "--horizon", "8", "1", "--repeat", "1"}, HasSubstr("--horizon: 1"));
  ExpectOneLine({LPVMPC, "bench", "step", "--horizon", "99999"}, HasSubstr("--horizon: 99999"));
}

TEST(Lpvmpc, RunPrintsItsSummaryAsJson) {
  const test_support::Outcome outcome =
      test_support::Run({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* key :
       {"completed", "steps", "infeasible_steps", "min_clearance_m", "min_road_margin_m",
        "rms_lateral_error_m", "solve_time_us", "median", "p99", "max", "deadline_misses"}) {
    EXPECT_THAT(outcome.out, HasSubstr('"' + std::string(key) + '"'));
  }
}

TEST(Lpvmpc, FailedExpectationIsToldAndGivesStatusOne) {
  const test_support::TempDir folder;
  const std::string file = Write(folder, "s.toml",
                                 "name = \"x\"\nroute = \"" + kDemo + "/route.toml\"\ndaemon_config = \"" +
                                     kDemo + "/lpvmpcd.toml\"\n[expect]\nmin_road_margin_m = 100.0\n");
  const test_support::Outcome outcome = test_support::Run({LPVMPC, "run", "--scenario", file});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("min_road_margin_m"));
}

TEST(LpvmpcSim, UnknownOptionIsNamed) {
  ExpectOneLine({LPVMPC_SIM, "--interface", "vcan0", "--scenario", "x", "--fast"}, HasSubstr("--fast"));
}

TEST(LpvmpcSim, MissingScenarioIsNamed) {
  ExpectOneLine({LPVMPC_SIM, "--interface", "vcan0", "--scenario", "/nowhere/s.toml"},
                HasSubstr("/nowhere/s.toml"));
}

TEST(Lpvmpcd, UnknownOptionIsNamed) {
  ExpectOneLine({LPVMPCD, "--confg", "x"}, HasSubstr("--confg"));
}

TEST(Lpvmpcd, MissingConfigurationIsNamed) {
  ExpectOneLine({LPVMPCD}, HasSubstr("--config is required"));
  ExpectOneLine({LPVMPCD, "--config", "/nowhere/c.toml"}, HasSubstr("/nowhere/c.toml"));
}

TEST(Lpvmpcd, CheckConfigNamesTheFileAndTheLineOfAWrongValue) {
  const test_support::TempDir folder;
  const std::string file = Write(folder, "c.toml",
                                 "[bus]\ninterface = \"vcan0\"\n[route]\nfile = \"" + kDemo +
                                     "/route.toml\"\n[controller]\nhorizon = -3\n");
  ExpectOneLine({LPVMPCD, "--config", file, "--check-config"},
                AllOf(HasSubstr(file + ":6:"), HasSubstr("horizon"), HasSubstr("-3"), HasSubstr("[")));
}

TEST(Lpvmpcd, NmpcIsRefusedWithItsReason) {
  ExpectOneLine({LPVMPCD, "--config", kDemo + "/lpvmpcd.toml", "--controller", "nmpc", "--check-config"},
                AllOf(HasSubstr("nmpc"), HasSubstr("lpv-standard")));
}

TEST(Lpvmpcd, CheckConfigAcceptsTheDemos) {
  EXPECT_EQ(test_support::Run({LPVMPCD, "--config", kDemo + "/lpvmpcd.toml", "--check-config"}).status, 0);
}

}  // namespace
