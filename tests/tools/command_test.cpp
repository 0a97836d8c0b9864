// Command lines of the three programs: an error yields one clear line on stderr and a non-zero status.
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/process.hpp"
#include "tests/support/temp_dir.hpp"
#include "tools/scenarios/scenario_seed.hpp"

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
  ExpectOneLine({LPVMPC}, HasSubstr("run, decode, bench, paper, sweep, falsify, catalogue or report"));
  ExpectOneLine({LPVMPC, "bench"}, HasSubstr("bench step"));
  ExpectOneLine({LPVMPC, "run"}, HasSubstr("--scenario"));
  ExpectOneLine({LPVMPC, "report", "-o", "x.html"}, HasSubstr("RUN_DIR"));
  ExpectOneLine({LPVMPC, "report", "x"}, HasSubstr("--output"));
}

TEST(Lpvmpc, CatalogueIsFoundBesideTheProgram) {
  const test_support::Outcome outcome =
      test_support::Run({LPVMPC, "catalogue", "--filter", "stop-at-end", "--jobs", "1"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1 passed, 0 failed"));
  const test_support::TempDir folder;
  const std::string in_folder =
      "cd " + folder.path().string() + " && exec " LPVMPC " catalogue --jobs 1 --filter stop-at-end ";
  EXPECT_EQ(test_support::Run({"sh", "-c", in_folder + "--report"}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "catalogue.html"));
  EXPECT_EQ(test_support::Run({"sh", "-c", in_folder + "--report named.html"}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "named.html"));
  ExpectOneLine({LPVMPC, "catalogue", "--filter", "no-such"}, HasSubstr("'no-such'"));
  ExpectOneLine({LPVMPC, "catalogue", "--scenarios", "/nowhere"}, HasSubstr("/nowhere"));
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

TEST(Lpvmpc, SweepRefusesWhatCannotBe) {
  const auto expect = [](std::vector<std::string> options, const testing::Matcher<std::string>& line) {
    options.insert(options.begin(), {LPVMPC, "sweep"});
    ExpectOneLine(options, line);
  };
  expect({"--seed", "1"}, HasSubstr("--count"));
  expect({"--count", "1"}, HasSubstr("--seed"));
  expect({"--count", "0", "--seed", "1"}, HasSubstr("--count"));
  expect({"--count", "1", "--seed", "-1"}, HasSubstr("--seed"));
  expect({"--count", "1", "--seed", "9007199254740992"}, HasSubstr("--seed"));
  expect({"--count", "1", "--seed", "1", "--jobs", "0"}, HasSubstr("--jobs"));
  expect({"--count", "1", "--seed", "1", "--speed", "9"}, HasSubstr("--speed"));
  expect({"--count", "1", "--seed", "1", "--speed", "9", "8"}, HasSubstr("--speed: 9 8 must be LO HI"));
  expect({"--count", "1", "--seed", "1", "--mu", "0.4", "1.3"}, HasSubstr("--mu: 0.4 1.3 must be LO HI"));
  expect({"--count", "1", "--seed", "1", "--shard", "3/2"}, HasSubstr("--shard: 3/2 must be i/n"));
  expect({"--count", "1", "--seed", "1", "--controller", "pid"}, AllOf(HasSubstr("pid"), HasSubstr("nmpc")));
  expect({"merge"}, HasSubstr("FILE"));
  expect({"merge", "/nowhere/part"}, HasSubstr("/nowhere/part"));
}

// A sweep of one scenario with the options, and `lpvmpc run` with `drawn` after it.
void ExpectRunDrivesAgain(const std::vector<std::string>& options, const std::vector<std::string>& drawn) {
  std::vector<std::string> sweep{LPVMPC, "sweep", "--count", "1", "--controller", "lpv-affine", "--json"};
  sweep.insert(sweep.end(), options.begin(), options.end());
  const std::string json = test_support::Run(sweep).out;
  const auto value = [](const std::string& text, const std::string& key) {
    const std::size_t at = text.find('"' + key + "\": ");
    return at == std::string::npos ? "no " + key : text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_THAT(json, HasSubstr("\"seed\": " + std::to_string(tools::ScenarioSeed(4, 0)) + ","));
  std::vector<std::string> run{LPVMPC, "run"};
  run.insert(run.end(), drawn.begin(), drawn.end());
  std::vector<std::string> summary = run;
  summary.emplace_back("--json");
  const std::string again = test_support::Run(summary).out;
  for (const char* key : {"steps", "infeasible_steps", "min_clearance_m", "min_road_margin_m"})
    EXPECT_EQ(value(again, key), value(json.substr(json.find("\"drives\"")), key));

  const test_support::TempDir folder;
  std::vector<std::string> out = run;
  out.insert(out.end(), {"--out", (folder.path() / "run").string()});
  EXPECT_LT(test_support::Run(out).status, 2);
  const std::string page = (folder.path() / "page.html").string();
  const test_support::Outcome report =
      test_support::Run({LPVMPC, "report", (folder.path() / "run").string(), "-o", page});
  EXPECT_EQ(report.status, 0) << report.err;
  EXPECT_GT(std::filesystem::file_size(page), 100'000u);
}

TEST(Lpvmpc, RunDrivesAScenarioOfASweepAgain) {
  const std::string seed = std::to_string(tools::ScenarioSeed(4, 0));
  ExpectRunDrivesAgain({"--seed", "4", "--speed", "9", "10"}, {"--sweep-seed", seed, "--speed", "9", "10"});
}

TEST(Lpvmpc, RunDrivesAScenarioWithTrafficOfASweepAgain) {
  const std::string seed = std::to_string(tools::ScenarioSeed(4, 0));
  ExpectRunDrivesAgain({"--seed", "4", "--traffic", "--mu", "0.8", "1"},
                       {"--sweep-seed", seed, "--traffic", "--mu", "0.8", "1"});
}

TEST(Lpvmpc, RunTakesAScenarioOrASweepsSeedNotBoth) {
  ExpectOneLine({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--sweep-seed", "1"},
                HasSubstr("--sweep-seed"));
  ExpectOneLine({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--speed", "8", "9"},
                HasSubstr("--sweep-seed"));
  ExpectOneLine({LPVMPC, "run", "--sweep-seed", "1", "--config", kDemo + "/lpvmpcd.toml"},
                HasSubstr("--config"));
  ExpectOneLine({LPVMPC, "run", "--sweep-seed", "1", "--speed", "1", "9"}, HasSubstr("--speed: 1 9 must be"));
  ExpectOneLine({LPVMPC, "run", "--scenario", kDemo + "/scenario.toml", "--traffic"},
                HasSubstr("--sweep-seed"));
  ExpectOneLine({LPVMPC, "run", "--traffic-key", "AA"}, HasSubstr("--traffic-key: a key has"));
  ExpectOneLine({LPVMPC, "run", "--traffic-key", "AA", "--sweep-seed", "1"}, HasSubstr("--traffic-key"));
}

TEST(Lpvmpc, FalsifyRefusesWhatCannotBe) {
  const auto expect = [](std::vector<std::string> options, const testing::Matcher<std::string>& line) {
    options.insert(options.begin(), {LPVMPC, "falsify"});
    ExpectOneLine(options, line);
  };
  expect({"--seed", "1"}, HasSubstr("--budget"));
  expect({"--budget", "1"}, HasSubstr("--seed"));
  expect({"--budget", "0", "--seed", "1"}, HasSubstr("--budget"));
  expect({"--budget", "1", "--seed", "1", "--speed", "9", "8"}, HasSubstr("--speed: 9 8 must be LO HI"));
  expect({"--budget", "1", "--seed", "1", "--controller", "pid"}, AllOf(HasSubstr("pid"), HasSubstr("lpv")));
  expect({"--budget", "1", "--seed", "1", "--shard", "0/2"}, HasSubstr("--shard: 0/2 must be i/n"));
  expect({"merge"}, HasSubstr("FILE"));
  expect({"merge", "/nowhere/part"}, HasSubstr("/nowhere/part"));
}

// The printed command drives the scenario again, and its folder holds all that a report needs.
TEST(Lpvmpc, WhatFalsifyFindsIsDrivenAgainByItsKey) {
  const test_support::Outcome found =
      test_support::Run({LPVMPC, "falsify", "--budget", "4", "--seed", "2", "--controller", "lpv"});
  EXPECT_EQ(found.status, 0) << found.err;
  const std::string option = "--traffic-key ";
  const std::size_t at = found.out.find(option);
  ASSERT_NE(at, std::string::npos) << found.out;
  const std::string key = found.out.substr(at + option.size(), found.out.find('\n', at) - at - option.size());
  const test_support::TempDir folder;
  const std::string run = (folder.path() / "run").string(), page = (folder.path() / "page.html").string();
  EXPECT_LT(
      test_support::Run({LPVMPC, "run", "--traffic-key", key, "--controller", "lpv", "--out", run}).status,
      2);
  EXPECT_EQ(test_support::Run({LPVMPC, "report", run, "-o", page}).status, 0);
  EXPECT_GT(std::filesystem::file_size(page), 100'000u);
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

TEST(Lpvmpc, OutputThatCannotBeWrittenIsReportedAndIsNoSuccess) {
  for (const std::string& command :
       {std::string(" run --scenario ") + kDemo + "/scenario.toml", std::string(" --help"),
        std::string(" bench step --horizon 8 --repeat 1")}) {
    ExpectOneLine({"sh", "-c", LPVMPC + command + " >/dev/full"}, HasSubstr("standard output"));
  }
}

TEST(Lpvmpc, InputThatCannotBeReadIsReportedAndIsNoSuccess) {
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

TEST(Lpvmpc, BenchQpSolvesRecordedProblemsColdAndWarm) {
  const test_support::Outcome outcome =
      test_support::Run({LPVMPC, "bench", "qp", LPVMPC_TEST_DATA "/qp", "--repeat", "1", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json lines = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(lines.size(), 4u);  // two horizons
  for (const nlohmann::json& line : lines) {
    EXPECT_EQ(line["solved"], line["instances"]) << line;
    EXPECT_LE(line["largest_kkt_residual"], 1e-8) << line;
    EXPECT_GT(line["solve"]["median_us"], 0.0);
  }
}

TEST(Lpvmpc, RecordedProblemsOfARunAreSolvedByBenchQp) {
  const test_support::TempDir folder;
  const std::string problems = (folder.path() / "qp").string();
  std::vector<std::string> run = {LPVMPC, "run", "--sweep-seed", "1001", "--record-qp", problems, "--json"};
  const test_support::Outcome drive = test_support::Run(run);
  ASSERT_EQ(drive.status, 0) << drive.err;
  const test_support::Outcome bench =
      test_support::Run({LPVMPC, "bench", "qp", problems, "--repeat", "1", "--json"});
  ASSERT_EQ(bench.status, 0) << bench.err;
  const nlohmann::json cold = nlohmann::json::parse(bench.out).at(0);
  EXPECT_GE(cold["instances"], nlohmann::json::parse(drive.out)["steps"]);
  EXPECT_EQ(cold["solved"], cold["instances"]);
  // Problems of two runs are not mixed, and a controller that solves none is reported.
  ExpectOneLine(run, HasSubstr(problems + " holds problems of another run"));
  run.insert(run.end() - 1, {"--controller", "nmpc-affine"});
  run[5] = problems + "2";
  ExpectOneLine(run, HasSubstr("nmpc-affine solves no quadratic problem"));
  EXPECT_FALSE(std::filesystem::exists(run[5]));
}

TEST(Lpvmpc, BenchQpNamesTheFileAndTheLineThatIsWrong) {
  const test_support::TempDir folder;
  const std::string dir = folder.path().string();
  ExpectOneLine({LPVMPC, "bench", "qp", dir}, HasSubstr("holds no *.qp"));
  ExpectOneLine({LPVMPC, "bench", "qp", dir + "/none"}, HasSubstr("/none: no such folder"));
  const auto expect = [&](const std::string& text, const std::string& message) {
    ExpectOneLine({LPVMPC, "bench", "qp", dir}, HasSubstr(Write(folder, "a.qp", text) + message));
  };
  expect("8 8\n3", ":2: nu = 3 must be a whole number in [2, 2]");
  expect("8 8 2\n1.0 x", ":2: x: not a number");
  expect("1 8 2\n0 0 0", ":2: ends too early");
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

TEST(Lpvmpc, FailedExpectationIsReportedAndGivesStatusOne) {
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
