#include "tools/sweep/sweep.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "config/text_file.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"
#include "tools/drive/sweep_config.hpp"
#include "tools/io/write_file.hpp"
#include "tools/scenarios/scenario_seed.hpp"
#include "tools/sweep/drive_sweep.hpp"
#include "tools/sweep/merge_parts.hpp"

namespace {

using test_support::ErrorOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using tools::PossibleWay;
using tools::Shard;
using tools::SweepDrive;
using tools::SweepOutcome;
using tools::SweepPart;
using tools::SweepResult;
using tools::SweepSetup;

SweepSetup Small() {
  return {.seed = 11, .count = 4, .ranges = {}, .controllers = {"lpv", "lpv-standard"}};
}

TEST(Shard, EveryScenarioIsInOne) {
  std::multiset<int> indices;
  for (int i = 1; i <= 3; ++i) {
    for (const int index : Shard{.index = i, .of = 3}.Indices(8)) {
      EXPECT_EQ(index % 3, i - 1);
      indices.insert(index);
    }
  }
  EXPECT_THAT(indices, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_TRUE((Shard{.index = 3, .of = 3}.Indices(2).empty()));
}

TEST(Shard, IsReadFromItsTextOrRefused) {
  EXPECT_EQ(tools::ParseShard("2/13"), (Shard{.index = 2, .of = 13}));
  for (const char* text : {"0/2", "3/2", "-1/2", "1/0", "1", "1/", "/2", "1/2x", "x1/2", "", "1.5/2"}) {
    EXPECT_THAT(ErrorOf([&] { (void)tools::ParseShard(text); }),
                AllOf(HasSubstr("--shard: " + std::string(text) + " must be"), HasSubstr("1 <= i <= n")));
  }
}

TEST(SweepSetup, WhatCannotBeIsRefusedInTheWordsOfTheCommandLine) {
  const auto error = [](const auto& spoil) {
    SweepSetup setup = Small();
    spoil(setup);
    return ErrorOf([&] { tools::CheckSetup(setup); });
  };
  EXPECT_EQ(error([](SweepSetup&) {}), "no error");
  EXPECT_EQ(error([](SweepSetup& s) { s.ranges.speed = {.low = 20.0, .high = 8.0}; }),
            "--speed: 20 8 must be LO HI with 3 <= LO <= HI <= 40");
  EXPECT_THAT(error([](SweepSetup& s) { s.ranges.speed = {.low = 2.9, .high = 8.0}; }),
              HasSubstr("--speed: 2.9 8"));
  EXPECT_THAT(error([](SweepSetup& s) { s.ranges.speed.high = 40.5; }), HasSubstr("--speed"));
  EXPECT_THAT(error([](SweepSetup& s) { s.ranges.speed.high = std::nan(""); }), HasSubstr("--speed"));
  EXPECT_EQ(error([](SweepSetup& s) { s.ranges.mu = {.low = 0.05, .high = 1.0}; }),
            "--mu: 0.05 1 must be LO HI with 0.1 <= LO <= HI <= 1.2");
  EXPECT_THAT(error([](SweepSetup& s) { s.controllers.emplace_back("pid"); }),
              AllOf(HasSubstr("pid"), HasSubstr("lpv-standard")));
  EXPECT_THAT(error([](SweepSetup& s) { s.controllers.emplace_back("nmpc"); }),
              AllOf(HasSubstr("nmpc-affine"), HasSubstr("lpv-standard, nmpc")));
  EXPECT_THAT(error([](SweepSetup& s) { s.controllers.emplace_back("lpv"); }),
              HasSubstr("lpv is named twice"));
  EXPECT_THAT(error([](SweepSetup& s) { s.controllers.clear(); }), HasSubstr("--controller"));
}

TEST(TimeHistogram, PercentilesAreThoseOfTheTimesWithinTwoPercent) {
  tools::TimeHistogram low, high;
  EXPECT_EQ(low.Percentile(0.5), 0.0);
  for (int i = 1; i <= 100; ++i) (i <= 50 ? low : high).Add(1e-6 * i);
  low.Add(high);
  for (const auto& [share, seconds] :
       {std::pair(0.5, 50e-6), std::pair(0.99, 99e-6), std::pair(1.0, 100e-6)}) {
    EXPECT_GE(low.Percentile(share), seconds * (1.0 - 1e-9));
    EXPECT_LE(low.Percentile(share), seconds * 1.02);
  }
}

// ---- the outcome of a summary

// Each figure that is bad, alone and together with those that count less.
TEST(SweepOutcomeTest, WorstOfWhatHappenedIsTheOutcome) {
  using enum SweepOutcome;
  using enum PossibleWay;
  sim::Expectations expect;
  expect.max_speed_excess_mps = 1.0;
  expect.max_end_overshoot_m = 0.3;
  sim::Summary summary;
  summary.completed = true;
  summary.steps = 100;
  summary.max_speed_excess_mps = 0.9;
  summary.end_overshoot_m = 0.2;
  const auto outcome = [&](PossibleWay way = kPass) { return tools::OutcomeOf(summary, expect, way); };
  EXPECT_EQ(outcome(), kPassed);
  summary.end_overshoot_m = 0.4;
  EXPECT_EQ(outcome(), kOverrun);
  EXPECT_EQ(tools::ReasonOf(kOverrun, summary), "0.40 m past the end");
  summary.max_speed_excess_mps = 1.25;
  EXPECT_EQ(outcome(), kTooFast);
  EXPECT_EQ(tools::ReasonOf(kTooFast, summary), "1.2 m/s above the target speed");
  summary.completed = false;
  EXPECT_EQ(outcome(), kFailed);
  summary.longest_free_standstill_s = 5.1;
  EXPECT_EQ(outcome(), kDeadlock);
  EXPECT_EQ(tools::ReasonOf(kDeadlock, summary), "stood for 5.1 s though the way was free");
  summary.safe_stops = 2;
  EXPECT_EQ(outcome(), kSafeStop);
  EXPECT_EQ(outcome(kStop), kSafeStop);
  EXPECT_EQ(outcome(kNone), kDeadlock) << "a safe stop is right where there is no way";
  EXPECT_EQ(tools::ReasonOf(kSafeStop, summary), "2 safe stops");
  summary.contact_step = 50;
  summary.contact_fault = sim::ContactFault::kTheirs;
  EXPECT_EQ(outcome(), kStruck);
  summary.off_road_step = 40;
  EXPECT_EQ(outcome(), kOffRoad);
  summary.contact_fault = sim::ContactFault::kOurs;
  EXPECT_EQ(outcome(), kOffRoad);
  summary.contact_step = 40;
  EXPECT_EQ(outcome(), kContact);
}

TEST(SweepOutcomeTest, StandingBeforeTheEndIsStoppedUnlessItWasTooFast) {
  sim::Summary summary;
  summary.standing = true;
  summary.max_speed_excess_mps = 2.0;
  sim::Expectations expect;
  EXPECT_EQ(tools::OutcomeOf(summary, expect, PossibleWay::kStop), SweepOutcome::kStopped);
  expect.max_speed_excess_mps = 1.0;
  EXPECT_EQ(tools::OutcomeOf(summary, expect, PossibleWay::kStop), SweepOutcome::kTooFast);
}

TEST(SweepOutcomeTest, BeingUnderWayWhereOneCanOnlyStopIsStopped) {
  sim::Summary summary;
  summary.steps = 100;
  EXPECT_EQ(tools::OutcomeOf(summary, {}, PossibleWay::kStop), SweepOutcome::kStopped);
  EXPECT_EQ(tools::OutcomeOf(summary, {}, PossibleWay::kPass), SweepOutcome::kFailed);
  summary.steps = 0;
  EXPECT_EQ(tools::OutcomeOf(summary, {}, PossibleWay::kStop), SweepOutcome::kFailed);
}

TEST(SweepOutcomeTest, NamesAndFailuresAreThoseThatAreSaid) {
  std::set<std::string> names;
  int failures = 0;
  for (const SweepOutcome outcome : tools::kAllOutcomes) {
    names.insert(tools::NameOf(outcome));
    failures += static_cast<int>(tools::IsFailure(outcome));
    EXPECT_EQ(tools::kAllOutcomes[static_cast<std::size_t>(outcome)], outcome);
  }
  EXPECT_EQ(names.size(), 10u);
  EXPECT_EQ(failures, 7);
}

// ---- a drive and its outcome

tools::RandomScenario WithoutObstacles(std::uint64_t seed) {
  tools::RandomScenario drawn = tools::DrawScenario(seed, {});
  drawn.scenario.obstacles.clear();
  drawn.scenario.appears_at.clear();
  return drawn;
}

SweepDrive DriveOf(const tools::RandomScenario& drawn) {
  return tools::DriveSweepScenario(drawn, PossibleWay::kPass, {}, "lpv").drive;
}

TEST(SweepDrive, RoadWithoutObstaclesIsPassed) {
  const SweepDrive drive = DriveOf(WithoutObstacles(3));
  EXPECT_EQ(drive.outcome, SweepOutcome::kPassed);
  EXPECT_EQ(drive.why, "");
  EXPECT_GT(drive.steps, 140);
  EXPECT_LT(drive.steps, 190);
  EXPECT_FALSE(drive.min_clearance_m);
  EXPECT_GT(drive.min_road_margin_m.value_or(-1.0), 0.0);
  EXPECT_GT(drive.cost.value_or(0.0), 0.0);
  EXPECT_GT(drive.rms_steering_rate.value_or(0.0), 0.0);
}

TEST(SweepDrive, WallThatIsSeenTooLateIsHit) {
  tools::RandomScenario drawn = WithoutObstacles(3);
  const control::RoutePoint at = drawn.scenario.route.At(40.0);
  drawn.scenario.obstacles = {{.id = 1, .X = at.X, .Y = at.Y, .r_x = 2.0, .r_y = 2.0}};
  drawn.scenario.appears_at[1] = 1e4;
  const SweepDrive drive = DriveOf(drawn);
  EXPECT_EQ(drive.outcome, SweepOutcome::kContact);
  EXPECT_THAT(drive.why, HasSubstr("contact at step "));
  EXPECT_LT(*drive.min_clearance_m, 0.0);
}

TEST(SweepDrive, CornerBesideTheRoadIsOffIt) {
  tools::RandomScenario drawn = WithoutObstacles(3);
  drawn.scenario.road = control::RoadBounds{.left = 0.5};  // the controller does not know of it
  const SweepDrive drive = DriveOf(drawn);
  EXPECT_EQ(drive.outcome, SweepOutcome::kOffRoad);
  EXPECT_THAT(drive.why, HasSubstr("off the road at step "));
}

TEST(SweepDrive, DriveThatTheDriverBrakesToAStopIsStopped) {
  const tools::ScenarioRanges slow{.speed = {.low = 5.0, .high = 5.0}, .mu = {.low = 0.8, .high = 1.0}};
  tools::RandomScenario drawn = tools::DrawScenario(3, slow);
  drawn.scenario.obstacles.clear();
  drawn.scenario.driver.brake_at = 1.0;
  drawn.scenario.road =
      control::RoadBounds{.left = 20.0, .right = -20.0};  // wide, since the driver does not steer
  EXPECT_EQ(tools::DriveSweepScenario(drawn, PossibleWay::kPass, slow, "lpv").drive.outcome,
            SweepOutcome::kStopped);
}

TEST(SweepDrive, DriveWithoutAnEngagementIsFailed) {
  tools::RandomScenario drawn = WithoutObstacles(3);
  drawn.scenario.driver.engage_at = 1e4;
  const SweepDrive drive = DriveOf(drawn);
  EXPECT_EQ(drive.outcome, SweepOutcome::kFailed);
  EXPECT_EQ(drive.why, "never engaged");
}

TEST(SweepDrive, SlowestStartIsFastEnoughToEngage) {
  const tools::ScenarioRanges ranges{.speed = tools::kSpeedLimits, .mu = {}};
  for (const std::string& controller : tools::SweepControllers())
    EXPECT_LT(tools::ConfigFor(controller, ranges).loop.engage_min_speed, 0.9 * ranges.speed.low);
}

// The cost of lpv-affine is compared with that of the nonlinear controller for the same problem.
TEST(SweepConfig, NmpcAffineHasTheProblemOfLpvAffine) {
  const loop::Config affine = tools::ConfigFor("lpv-affine", {}), nmpc = tools::ConfigFor("nmpc-affine", {});
  EXPECT_EQ(nmpc.controller, loop::ControllerKind::kNmpcAffine);
  EXPECT_EQ(HorizonOf(nmpc), HorizonOf(affine));
  EXPECT_EQ(nmpc.affine.mu, affine.affine.mu);
  EXPECT_EQ(nmpc.affine.footprint.half_width, affine.affine.footprint.half_width);
  EXPECT_EQ(nmpc.loop.command_delay, affine.loop.command_delay);
  EXPECT_FALSE(IsPapers(nmpc.controller));
  // The name of the kind, as written to a drive's file, can be read back.
  EXPECT_EQ(tools::ConfigFor(loop::ControllerName(nmpc.controller), {}).controller, nmpc.controller);
}

// ---- the table

SweepResult MadeUp() {
  using enum SweepOutcome;
  const auto drive = [](SweepOutcome outcome, double cost, double clearance) {
    return SweepDrive{.outcome = outcome,
                      .why = IsFailure(outcome) ? "made up" : "",
                      .min_clearance_m = clearance,
                      .min_road_margin_m = 1.0,
                      .cost = cost,
                      .rms_steering_rate = 0.1 * cost,
                      .rms_jerk = cost};
  };
  SweepResult result{.setup = {.seed = 1, .count = 4, .ranges = {}, .controllers = {"lpv", "nmpc-affine"}},
                     .scenarios = {},
                     .times = {}};
  result.times.resize(2);
  const auto add = [&](PossibleWay way, const SweepDrive& lpv, const SweepDrive& nmpc) {
    result.scenarios.push_back({.index = static_cast<int>(result.scenarios.size()),
                                .seed = 100 + result.scenarios.size(),
                                .description = "one line",
                                .way = way,
                                .drives = {lpv, nmpc}});
  };
  add(PossibleWay::kPass, drive(kPassed, 3.0, 0.2), drive(kPassed, 2.0, 0.2));
  add(PossibleWay::kPass, drive(kContact, 9.0, -0.1), drive(kPassed, 4.0, 0.2));
  add(PossibleWay::kNone, drive(kOffRoad, 9.0, -0.9), drive(kContact, 9.0, -0.8));
  add(PossibleWay::kStop, drive(kStopped, 9.0, 0.9), drive(kContact, 9.0, -0.3));
  return result;
}

TEST(SweepTable, CountsOutcomesAndTakesMediansOverWhatPassed) {
  const auto table = tools::Tabulate(MadeUp());
  ASSERT_EQ(table.size(), 2u);
  EXPECT_THAT(table[0].outcomes, ElementsAre(1, 1, 0, 1, 1, 0, 0, 0, 0, 0));
  EXPECT_THAT(table[1].outcomes, ElementsAre(2, 0, 0, 2, 0, 0, 0, 0, 0, 0));
  EXPECT_EQ(table[0].passed_of_passable, 1);
  EXPECT_EQ(table[1].passed_of_passable, 2);
  EXPECT_EQ(table[0].failures_of_possible, 1);
  EXPECT_EQ(table[1].failures_of_possible, 1);
  EXPECT_EQ(table[0].cost_ratio, 1.5);
  EXPECT_EQ(table[1].cost_ratio, 1.0);
  EXPECT_EQ(table[0].jerk, 3.0);
  EXPECT_EQ(table[1].jerk, 2.0);  // the lower of two, nearest rank
}

TEST(SweepTable, CostIsComparedOnlyWhereTheNmpcDroveToo) {
  SweepResult result = MadeUp();
  result.setup.controllers = {"lpv", "lpv-standard"};
  EXPECT_FALSE(tools::Tabulate(result)[0].cost_ratio);
}

TEST(SweepFailures, WorstAreThoseThatHadAWayThenTheDeepest) {
  const auto worst = tools::WorstFailures(MadeUp(), 3);
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (const auto& failure : worst) places.emplace_back(failure.scenario, failure.controller);
  EXPECT_THAT(places, ElementsAre(std::pair(3u, 1u), std::pair(1u, 0u), std::pair(2u, 0u)));
}

TEST(SweepText, TellsEachFailureWithSeedScenarioControllerAndReason) {
  const std::string text = tools::ToText(MadeUp());
  EXPECT_THAT(text, HasSubstr("  101  one line; possible: pass\n      lpv           made up\n"));
  EXPECT_THAT(
      text,
      HasSubstr(
          "  102  one line; possible: none\n      lpv           made up\n      nmpc-affine   made up\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("  100  ")));
  EXPECT_THAT(text, HasSubstr("lpvmpc run --sweep-seed SEED --speed 8 20 --mu 0.4 1 --controller NAME"));
}

// ---- the sweep

TEST(Sweep, DoesNotDependOnTheNumberOfProcesses) {
  const SweepPart one = tools::DriveSweep(Small(), {}, 1), two = tools::DriveSweep(Small(), {}, 2);
  EXPECT_EQ(tools::ToJson(one.result).dump(), tools::ToJson(two.result).dump());
  ASSERT_EQ(one.result.scenarios.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const tools::SweptScenario& scenario = one.result.scenarios[i];
    EXPECT_EQ(scenario.seed, tools::ScenarioSeed(11, i));
    ASSERT_EQ(scenario.drives.size(), 2u);
    EXPECT_GT(scenario.drives[0].steps, 0);
  }
  const auto timing = tools::TimingJson(one.result);
  EXPECT_GT(timing.at("lpv").at("steps"), 4 * 100);
  EXPECT_GT(timing.at("lpv").at("median_s"), 0.0);
  EXPECT_FALSE(tools::ToJson(one.result).contains("timing"));
}

class Parts : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path Write(const SweepPart& part, const std::string& name) const {
    const std::filesystem::path file = folder_.path() / name;
    tools::WriteFile(file, tools::PartJson(part).dump(2));
    return file;
  }
  [[nodiscard]] std::string ErrorOfMerge(const std::vector<std::filesystem::path>& files) const {
    return ErrorOf([&] { (void)tools::MergeParts(files); });
  }
  // A part with made-up drives.
  static SweepPart Made(const SweepSetup& setup, const Shard& shard) {
    SweepPart part{.result = {.setup = setup, .scenarios = {}, .times = {}}, .shard = shard};
    for (const int index : shard.Indices(setup.count)) {
      part.result.scenarios.push_back(
          {.index = index,
           .seed = tools::ScenarioSeed(setup.seed, static_cast<std::uint64_t>(index)),
           .description = "made up",
           .way = PossibleWay::kStop,
           .drives = {}});
      part.result.scenarios.back().drives.resize(setup.controllers.size());
    }
    part.result.times.resize(setup.controllers.size());
    part.result.times[0].Add(1e-5);
    return part;
  }

  test_support::TempDir folder_;
};

TEST_F(Parts, JoinedGiveTheWholeByteForByte) {
  const SweepPart whole = tools::DriveSweep(Small(), {}, 2);
  std::vector<std::filesystem::path> files;
  for (const int i : {3, 1, 2}) {
    const Shard shard{.index = i, .of = 3};
    files.push_back(Write(tools::DriveSweep(Small(), shard, 2), std::to_string(i)));
  }
  const SweepResult merged = tools::MergeParts(files);
  EXPECT_EQ(tools::ToJson(merged).dump(), tools::ToJson(whole.result).dump());
  EXPECT_EQ(tools::TimingJson(merged).at("lpv").at("steps"),
            tools::TimingJson(whole.result).at("lpv").at("steps"));
}

TEST_F(Parts, WithTrafficGiveTheWholeToo) {
  SweepSetup setup = Small();
  setup.ranges.traffic = true;
  setup.controllers = {"lpv"};
  const SweepPart whole = tools::DriveSweep(setup, {}, 2);
  std::vector<std::filesystem::path> files;
  for (const int i : {2, 1})
    files.push_back(Write(tools::DriveSweep(setup, {.index = i, .of = 2}, 1), std::to_string(i)));
  EXPECT_EQ(tools::ToJson(tools::MergeParts(files)).dump(), tools::ToJson(whole.result).dump());
  EXPECT_NE(whole.result.scenarios[0].description,
            tools::DrawScenario(whole.result.scenarios[0].seed, {}).scenario.description);
  EXPECT_EQ(setup.Describe(), "4 scenarios with traffic of seed 11, 8..20 m/s, mu 0.4..1, by lpv");
  EXPECT_EQ(setup.CommandToDriveAgain(),
            "lpvmpc run --sweep-seed SEED --traffic --speed 8 20 --mu 0.4 1 --controller NAME");
}

TEST_F(Parts, MoreShardsThanScenariosLeaveSomeEmpty) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i <= 6; ++i)
    files.push_back(Write(Made(Small(), {.index = i, .of = 6}), std::to_string(i)));
  EXPECT_EQ(tools::MergeParts(files).scenarios.size(), 4u);
}

TEST_F(Parts, OfAnotherSweepAreRefusedWithTheirFile) {
  const auto first = Write(Made(Small(), {.index = 1, .of = 2}), "first");
  const auto error = [&](const auto& change) {
    SweepSetup setup = Small();
    change(setup);
    return ErrorOfMerge({first, Write(Made(setup, {.index = 2, .of = 2}), "other")});
  };
  EXPECT_EQ(error([](SweepSetup&) {}), "no error");
  const std::string place =
      (folder_.path() / "other").string() + ": is of another sweep than " + first.string();
  EXPECT_THAT(error([](SweepSetup& s) { s.seed = 12; }),
              AllOf(HasSubstr(place), HasSubstr("seed 12"), HasSubstr("seed 11")));
  EXPECT_THAT(error([](SweepSetup& s) { s.count = 5; }), AllOf(HasSubstr(place), HasSubstr("5 scenarios")));
  EXPECT_THAT(error([](SweepSetup& s) { s.ranges.speed.high = 21.0; }),
              AllOf(HasSubstr(place), HasSubstr("8..21 m/s")));
  EXPECT_THAT(error([](SweepSetup& s) { s.ranges.mu.high = 1.1; }),
              AllOf(HasSubstr(place), HasSubstr("mu 0.4..1.1")));
  EXPECT_THAT(error([](SweepSetup& s) { s.ranges.traffic = true; }),
              AllOf(HasSubstr(place), HasSubstr("with traffic")));
  EXPECT_THAT(error([](SweepSetup& s) {
                s.controllers = {"lpv", "nmpc-affine"};
              }),
              AllOf(HasSubstr(place), HasSubstr("lpv, nmpc")));
  EXPECT_THAT(ErrorOfMerge({first, Write(Made(Small(), {.index = 2, .of = 3}), "other")}),
              AllOf(HasSubstr(place), HasSubstr("3 shards instead of 2")));
}

TEST_F(Parts, ThatAreLackingOrThereTwiceAreNamed) {
  const auto a = Write(Made(Small(), {.index = 1, .of = 4}), "a"),
             b = Write(Made(Small(), {.index = 3, .of = 4}), "b");
  EXPECT_EQ(ErrorOfMerge({a, b}), a.string() + ": no file is shard 2/4, 4/4 of its sweep");
  EXPECT_EQ(ErrorOfMerge({a, b, a}), a.string() + ": is shard 1/4, as " + a.string() + " is");
}

TEST_F(Parts, WhatIsNoneIsRefusedWithItsFile) {
  const std::filesystem::path file = folder_.path() / "part";
  const auto error = [&](const std::string& text) {
    tools::WriteFile(file, text);
    return ErrorOfMerge({file});
  };
  const std::string text = tools::PartJson(Made(Small(), {.index = 1, .of = 1})).dump();
  EXPECT_EQ(error(text), "no error");
  const std::string place = file.string() + ": is not a part of a sweep: ";
  EXPECT_THAT(error(""), HasSubstr(place));
  EXPECT_THAT(error(text.substr(0, text.size() / 2)), HasSubstr(place));
  EXPECT_THAT(error("[]"), HasSubstr(place));
  // The file of a whole sweep has no shard.
  EXPECT_THAT(error(tools::ToJson(Made(Small(), {}).result).dump()),
              AllOf(HasSubstr(place), HasSubstr("shard")));
  SweepPart part = Made(Small(), {.index = 1, .of = 1});
  part.result.scenarios.pop_back();
  EXPECT_THAT(error(tools::PartJson(part).dump()),
              AllOf(HasSubstr(place), HasSubstr("not those of its shard")));
  part = Made(Small(), {.index = 1, .of = 1});
  part.result.scenarios[1].seed += 1;
  EXPECT_THAT(error(tools::PartJson(part).dump()), HasSubstr("not those of its shard"));
  EXPECT_THAT(error(tools::PartJson(Made(Small(), {.index = 3, .of = 2})).dump()),
              HasSubstr("shard 3/2 does not exist"));
  EXPECT_THAT(ErrorOfMerge({folder_.path() / "none"}), HasSubstr("none: cannot be read"));
}

TEST_F(Parts, CommandWritesTheSameFolderAsTheWholeSweepButForTimes) {
  const std::filesystem::path whole = folder_.path() / "whole", merged = folder_.path() / "merged";
  std::ostringstream out;
  SweepSetup setup = Small();
  setup.count = 2;
  tools::Sweep({.setup = setup, .jobs = 2, .shard = {}, .out = whole}, out);
  tools::SweepMergeOptions merge{.parts = {}, .out = merged};
  for (int i = 1; i <= 2; ++i) {
    merge.parts.push_back(folder_.path() / ("part" + std::to_string(i)));
    tools::Sweep({.setup = setup, .jobs = 1, .shard = Shard{.index = i, .of = 2}, .out = merge.parts.back()},
                 out);
  }
  tools::MergeSweep(merge, out);
  EXPECT_EQ(config::ReadTextFile(whole / "sweep.json"), config::ReadTextFile(merged / "sweep.json"));
  for (const char* file : {"timing.json", "report.json", "report.html"})
    EXPECT_GT(std::filesystem::file_size(merged / file), 50u) << file;
  EXPECT_THAT(out.str(), HasSubstr("report: " + (merged / "report.html").string()));
}

}  // namespace
