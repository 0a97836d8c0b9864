#include "tools/falsify/falsify.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "config/text_file.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"
#include "tools/io/write_file.hpp"

namespace {

using test_support::ErrorOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using tools::FalsifyPart;
using tools::FalsifyResult;
using tools::FalsifySearch;
using tools::FalsifySetup;
using tools::Finding;
using tools::PossibleWay;
using tools::SweepOutcome;

FalsifySetup Small() {
  FalsifySetup setup{.seed = 3, .budget = 12};
  setup.controller = "lpv";  // quick
  return setup;
}

// ---- the setup

TEST(FalsifySetup, SearchesShareTheBudget) {
  FalsifySetup setup = Small();
  EXPECT_EQ(setup.Searches(), 1);
  EXPECT_EQ(setup.DrivesOf(0), 12);
  setup.budget = 4100;
  EXPECT_EQ(setup.Searches(), 3);
  EXPECT_EQ(setup.DrivesOf(0) + setup.DrivesOf(1) + setup.DrivesOf(2), 4100);
  EXPECT_EQ(setup.DrivesOf(2), 100);
  setup.budget = 4000;
  EXPECT_EQ(setup.Searches(), 2);
}

TEST(FalsifySetup, IsToldInOneLine) {
  EXPECT_EQ(Small().Describe(), "12 drives of seed 3 in 1 search, 8..20 m/s, mu 0.4..1, by lpv");
  EXPECT_EQ(Small().CommandToDriveAgain("AB"),
            "lpvmpc run --speed 8 20 --mu 0.4 1 --controller lpv --traffic-key AB");
}

TEST(FalsifySetup, WhatCannotBeIsRefused) {
  FalsifySetup setup = Small();
  EXPECT_EQ(ErrorOf([&] { tools::CheckSetup(setup); }), "no error");
  setup.controller = "pid";
  EXPECT_THAT(ErrorOf([&] { tools::CheckSetup(setup); }), AllOf(HasSubstr("--controller"), HasSubstr("pid")));
  setup = Small();
  setup.ranges.mu = {.low = 0.05, .high = 1.0};
  EXPECT_THAT(ErrorOf([&] { tools::CheckSetup(setup); }), HasSubstr("--mu"));
}

// ---- the margin

TEST(Margin, IsTheSmallerOfClearanceAndDistanceFromTheEdge) {
  sim::Summary summary;
  EXPECT_FALSE(tools::MarginOf(summary));
  summary.min_road_margin_m = 0.4;
  EXPECT_EQ(tools::MarginOf(summary), 0.4);
  summary.min_clearance_m = 0.3;
  EXPECT_EQ(tools::MarginOf(summary), 0.3);
  summary.min_road_margin_m = -0.1;
  EXPECT_EQ(tools::MarginOf(summary), -0.1);
}

TEST(Margin, ContactByTheOthersFaultDoesNotCount) {
  sim::Summary summary;
  summary.min_road_margin_m = 0.4;
  summary.min_clearance_m = -0.3;
  summary.contact_fault = sim::ContactFault::kTheirs;
  EXPECT_EQ(tools::MarginOf(summary), 0.4);
  summary.contact_fault = sim::ContactFault::kOurs;
  EXPECT_EQ(tools::MarginOf(summary), -0.3);
}

// ---- text and JSON

FalsifySearch Made(int index, double margin) {
  return {.index = index,
          .impossible = 2,
          .violated = 1,
          .least = {0.5, std::nullopt, margin},
          .worst = Finding{.key = "KEY" + std::to_string(index),
                           .margin = margin,
                           .outcome = margin < 0.0 ? SweepOutcome::kContact : SweepOutcome::kPassed,
                           .why = margin < 0.0 ? "contact at step 9" : "",
                           .way = PossibleWay::kPass,
                           .description = "made up"}};
}

FalsifyResult MadeUp() {
  FalsifySetup setup = Small();
  setup.budget = 3 * tools::kDrivesOfSearch;
  return {.setup = setup, .searches = {Made(0, 0.25), Made(1, -0.5), Made(2, 0.125)}};
}

TEST(FalsifyText, WorstAreThoseWithTheLeastMargin) {
  FalsifyResult result = MadeUp();
  std::vector<int> indices;
  for (const FalsifySearch* search : tools::Worst(result, 5)) indices.push_back(search->index);
  EXPECT_THAT(indices, ElementsAre(1, 2, 0));
  result.searches[2].worst.reset();
  EXPECT_EQ(tools::Worst(result, 5).size(), 2u);
  EXPECT_EQ(tools::Worst(result, 1).size(), 1u);
}

TEST(FalsifyText, TellsMarginOutcomeAndTheCommandThatDrivesItAgain) {
  const std::string text = tools::ToText(MadeUp(), 2);
  EXPECT_THAT(text, HasSubstr("off the road: 3 drives; 6 more, in which there was no way"));
  EXPECT_THAT(text, HasSubstr("  -0.500 m, contact: contact at step 9; possible: pass; search 1\n"));
  EXPECT_THAT(text, HasSubstr("  0.125 m, passed; possible: pass; search 2\n"));
  EXPECT_THAT(text, HasSubstr("--traffic-key KEY1\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("KEY0")));
}

// ---- the search

TEST(Falsify, DoesNotDependOnTheNumberOfProcesses) {
  const FalsifyPart one = tools::RunSearches(Small(), {}, 1), two = tools::RunSearches(Small(), {}, 2);
  EXPECT_EQ(tools::ToJson(one.result).dump(), tools::ToJson(two.result).dump());
  ASSERT_EQ(one.result.searches.size(), 1u);
  const FalsifySearch& search = one.result.searches[0];
  ASSERT_TRUE(search.worst);
  ASSERT_EQ(search.least.size(), 1u);
  EXPECT_EQ(search.least[0], search.worst->margin);
}

TEST(Falsify, WorstHasItsMarginAgainWhenItIsDrivenByItsKey) {
  const FalsifyPart part = tools::RunSearches(Small(), {}, 2);
  const Finding& worst = *part.result.searches[0].worst;
  EXPECT_EQ(tools::DriveMargin(tools::PointOf(worst.key), Small()), worst.margin);
  EXPECT_EQ(tools::FindingOf(tools::PointOf(worst.key), worst.margin, Small()).description,
            worst.description);
}

TEST(Falsify, DriveWithoutAWayDoesNotCount) {
  // "lpv" hits nearly everything: among the drives of a small search with late perception, some have no way.
  FalsifySetup setup = Small();
  setup.budget = 24;
  setup.ranges.speed = {.low = 18.0, .high = 20.0};
  setup.ranges.mu = {.low = 0.3, .high = 0.35};
  const FalsifySearch search = tools::RunSearches(setup, {}, 2).result.searches[0];
  EXPECT_GT(search.impossible, 0);
  EXPECT_GT(search.violated, 0);
  EXPECT_LE(search.impossible + search.violated, 24);
  EXPECT_NE(search.worst->way, PossibleWay::kNone);
}

// ---- shards

class FalsifyParts : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path Write(const FalsifyPart& part, const std::string& name) const {
    const std::filesystem::path file = folder_.path() / name;
    tools::WriteFile(file, tools::PartJson(part).dump(2));
    return file;
  }
  // The searches of a shard of the made-up result.
  [[nodiscard]] static FalsifyPart Shard(int index, int of) {
    FalsifyPart part{.result = {.setup = MadeUp().setup, .searches = {}},
                     .shard = {.index = index, .of = of}};
    for (const int search : part.shard.Indices(3))
      part.result.searches.push_back(MadeUp().searches[static_cast<std::size_t>(search)]);
    return part;
  }

  test_support::TempDir folder_;
};

TEST_F(FalsifyParts, JoinedGiveTheWholeByteForByte) {
  std::ostringstream out;
  tools::MergeFalsify({.parts = {Write(Shard(2, 2), "b"), Write(Shard(1, 2), "a")},
                       .out = folder_.path() / "whole.json",
                       .json = true},
                      out);
  EXPECT_EQ(out.str(), tools::ToJson(MadeUp()).dump(2) + "\n");
  EXPECT_EQ(config::ReadTextFile(folder_.path() / "whole.json"), out.str());
}

TEST_F(FalsifyParts, WhatDoesNotMakeUpTheWholeIsRefusedWithItsFile) {
  const auto first = Write(Shard(1, 2), "first");
  const auto error = [&](const FalsifyPart& part) {
    std::ostringstream out;
    return ErrorOf([&] { tools::MergeFalsify({.parts = {first, Write(part, "other")}, .out = ""}, out); });
  };
  EXPECT_EQ(error(Shard(2, 2)), "no error");
  const std::string place = (folder_.path() / "other").string();
  EXPECT_THAT(error(Shard(1, 2)), HasSubstr(place + ": is shard 1/2"));
  EXPECT_THAT(error(Shard(2, 3)), AllOf(HasSubstr(place), HasSubstr("3 shards instead of 2")));
  FalsifyPart other = Shard(2, 2);
  other.result.setup.seed = 4;
  EXPECT_THAT(error(other),
              AllOf(HasSubstr(place), HasSubstr("of another falsification"), HasSubstr("seed 4")));
  other = Shard(2, 2);
  other.result.searches[0].index = 2;
  EXPECT_THAT(error(other), HasSubstr("its searches are not those of its shard"));
  std::ostringstream out;
  EXPECT_THAT(ErrorOf([&] { tools::MergeFalsify({.parts = {first}, .out = ""}, out); }),
              HasSubstr("no file is shard 2/2 of its falsification"));
}

TEST_F(FalsifyParts, CommandWritesThePartsThatMergeTakes) {
  std::ostringstream whole, merged;
  tools::Falsify({.setup = Small(), .jobs = 2, .shard = {}, .out = "", .json = true}, whole);
  std::vector<std::filesystem::path> parts;
  for (int i = 1; i <= 2; ++i) {
    std::ostringstream out;
    parts.push_back(folder_.path() / std::to_string(i));
    tools::Falsify(
        {.setup = Small(), .jobs = 1, .shard = tools::Shard{.index = i, .of = 2}, .out = parts.back()}, out);
    EXPECT_EQ(out.str(), "");
  }
  tools::MergeFalsify({.parts = parts, .out = "", .json = true}, merged);
  EXPECT_EQ(merged.str(), whole.str());
}

}  // namespace
