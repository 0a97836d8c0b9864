#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/paper/paper_result.hpp"

namespace {

using tools::CircleDrive;
using tools::CircleOutcome;
using tools::Claim;
using tools::PaperResult;

const std::filesystem::path kScenarios = LPVMPC_SOURCE_DIR "/scenarios/paper";

const std::vector<tools::FeasibilityRow>& Ten() {
  static const std::vector<tools::FeasibilityRow> rows = [] {
    tools::ProgressBar bar(1);
    return tools::CompareFeasibility(kScenarios / "feasibility", bar);
  }();
  return rows;
}

int Failing(const PaperResult& result) {
  const std::vector<Claim> claims = tools::JudgeClaims(result);
  return static_cast<int>(std::ranges::count(claims, false, &Claim::holds));
}

TEST(FeasibilityScenarios, AreThoseOfThePaper) {
  std::vector<double> radii;
  int long_horizons = 0;
  for (const tools::FeasibilityRow& row : Ten()) {
    const auto& obstacle = row.trust_region.record.objects.at(0).first;
    EXPECT_EQ(obstacle.r_x, obstacle.r_y) << row.number;
    radii.push_back(obstacle.r_x);
    const int horizon = row.trust_region.config.mpc.horizon;
    EXPECT_TRUE(horizon == 8 || horizon == 15) << row.number;
    long_horizons += static_cast<int>(horizon == 15);
    // The whole road is a circle.
    const double curvature = row.road.route.At(0.0).curvature;
    EXPECT_GT(curvature, 0.0);
    EXPECT_NEAR(row.road.route.At(0.9 * row.road.route.length()).curvature, curvature, 1e-12);
    // The horizons are equal; one of the two has the trust region.
    EXPECT_EQ(row.standard.config.mpc.horizon, horizon);
    EXPECT_FALSE(row.standard.config.mpc.trust_region);
    EXPECT_TRUE(row.trust_region.config.mpc.trust_region);
  }
  EXPECT_EQ(Ten().size(), 10u);
  EXPECT_NEAR(std::ranges::min(radii), 0.7, 0.002);
  EXPECT_NEAR(std::ranges::max(radii), 1.4, 0.002);
  EXPECT_EQ(long_horizons, 5);
}

TEST(FeasibilityScenarios, TrustRegionIsFeasibleInAllAndTheStandardControllerInThreeAtMost) {
  int standard = 0;
  for (const tools::FeasibilityRow& row : Ten()) {
    EXPECT_TRUE(row.trust_region.feasible()) << row.number;
    EXPECT_GE(row.trust_region.figures.summary.min_clearance_m.value_or(-1.0), 0.0) << row.number;
    standard += static_cast<int>(row.standard.feasible());
    if (row.standard.feasible()) continue;
    // The obstacle makes it infeasible.
    const auto& failure = row.standard.figures.first_failure;
    ASSERT_TRUE(failure && failure->violation) << row.number;
    EXPECT_EQ(failure->violation->constraint.kind, control::ConstraintKind::kObstacle) << row.number;
    EXPECT_GT(failure->violation->amount, 0.0);
  }
  EXPECT_LE(standard, 3);
}

TEST(CircleDrive, OutcomeTellsTheControllersApart) {
  using enum loop::ControllerKind;
  EXPECT_EQ(tools::Drive({.speed = 12.0, .shift = 0.5, .horizon = 15, .controller = kLpv}),
            CircleOutcome::kClear);
  EXPECT_EQ(tools::Drive({.speed = 12.0, .shift = 0.5, .horizon = 15, .controller = kLpvStandard}),
            CircleOutcome::kInfeasible);
  EXPECT_EQ(tools::Drive({.speed = 12.0, .shift = 0.1, .horizon = 8, .controller = kNmpc}),
            CircleOutcome::kClear);
}

TEST(CircleDrive, StepThatLacksMillimetresIsMarginalOneThatLacksMoreIsInfeasible) {
  using enum loop::ControllerKind;
  EXPECT_EQ(tools::Drive({.speed = 12.0, .shift = 0.5, .horizon = 15, .controller = kNmpc}),
            CircleOutcome::kMarginal);
  EXPECT_EQ(tools::Drive({.speed = 11.0, .shift = 1.4, .horizon = 8, .controller = kLpv}),
            CircleOutcome::kInfeasible);
}

// A made-up result, for the claims about known figures.
PaperResult MadeUp() {
  PaperResult result;
  result.feasibility = Ten();
  const config::RouteFile road = Ten()[0].road;
  const tools::ComparedDrive nothing;
  for (const char* name : {"tracking-1", "obstacle-1"}) {
    tools::ComparisonRow row{.name = name,
                             .description = name,
                             .has_obstacle = name[0] == 'o',
                             .road = road,
                             .paper_nmpc = {0.3, 1.0, 0.1},
                             .paper_lpv = {0.015, 0.02, 0.01},
                             .nmpc = nothing,
                             .lpv = nothing};
    for (tools::ComparedDrive* drive : {&row.nmpc, &row.lpv}) {
      drive->figures.summary.completed = true;
      drive->figures.cost = drive == &row.nmpc ? 2.0 : 3.0;
      if (row.has_obstacle) drive->figures.summary.min_clearance_m = 0.05;
    }
    row.nmpc.times = {4e-3, 8e-3, 2e-3};
    row.lpv.times = {1e-4, 8e-4, 1e-5};
    result.comparison.push_back(row);
  }
  return result;
}

TEST(JudgeClaims, HoldWhereTheFiguresSaySo) {
  const PaperResult result = MadeUp();
  EXPECT_EQ(Failing(result), 0);
  EXPECT_DOUBLE_EQ(result.comparison[0].speedup(), 40.0);
  EXPECT_DOUBLE_EQ(result.comparison[0].cost_gap(), 0.5);
  EXPECT_TRUE(tools::ToJson(result).at("passed"));
}

TEST(JudgeClaims, EachFailsByItself) {
  PaperResult result = MadeUp();
  result.feasibility[4].trust_region.figures.first_failure = tools::FirstFailure{};
  EXPECT_EQ(Failing(result), 1);
  EXPECT_FALSE(tools::ToJson(result).at("passed"));

  result = MadeUp();
  for (tools::FeasibilityRow& row : result.feasibility) row.standard.figures.first_failure.reset();
  EXPECT_EQ(Failing(result), 1);

  result = MadeUp();
  result.feasibility[0].trust_region.figures.summary.completed = false;
  EXPECT_EQ(Failing(result), 1);

  result = MadeUp();
  result.comparison[0].lpv.times.average = 2.1e-4;  // a speedup of 19
  EXPECT_EQ(Failing(result), 1);

  result = MadeUp();
  result.comparison[1].nmpc.figures.summary.min_clearance_m = -0.001;
  EXPECT_EQ(Failing(result), 1);

  result = MadeUp();
  result.comparison[0].lpv.figures.summary.failed_expectations = {"completed = false"};
  EXPECT_EQ(Failing(result), 1);
}

TEST(PaperText, TellsTheViolatedConstraintAndThePapersFigures) {
  const std::string text = tools::ToText(MadeUp());
  EXPECT_THAT(text, testing::HasSubstr("infeasible: obstacle 1 at i = "));
  EXPECT_THAT(text, testing::HasSubstr("300.0ms"));
  EXPECT_THAT(text, testing::HasSubstr("+50.0 %"));
  EXPECT_EQ(tools::PercentText(-0.0001), "+0.0 %");
}

tools::FeasibilityMap MadeUpMap() {
  using enum CircleOutcome;
  return {.speeds = {10.0, 11.0, 12.0},
          .shifts = {0.1, 0.2, 0.3},
          .panels = {
              {.controller = loop::ControllerKind::kLpv,
               .horizon = 8,
               .cells = {{kClear, kClear, kMarginal}, {kClear, kTouch, kClear}, {kClear, kClear, kClear}}}}};
}

TEST(FeasibilityMap, IsReportedInTextJsonAndPage) {
  PaperResult result = MadeUp();
  const std::size_t sections = tools::PaperPage(result).at("sections").size();
  EXPECT_TRUE(tools::ToJson(result).at("map").is_null());
  result.map = MadeUpMap();
  // Shifts increase upwards.
  EXPECT_THAT(tools::ToText(result),
              testing::HasSubstr("   0.2 m   .  t  .\n   0.1 m   .  .  m\n          10 11 12 m/s"));
  const auto map = tools::ToJson(result).at("map");
  EXPECT_EQ(map.at("panels").at(0).at("clear"), 7);
  EXPECT_EQ(map.at("panels").at(0).at("limit_m").dump(), "[0.3,0.1,null]");
  EXPECT_EQ(map.at("panels").at(0).at("cells").at(1).at(1), "touch");
  const auto page = tools::PaperPage(result).at("sections");
  ASSERT_EQ(page.size(), sections + 2);
  const auto& section = page.at(sections);
  EXPECT_EQ(section.at("type"), "map");
  EXPECT_EQ(section.at("panels").at(0).at("cells").at(0).at(2), "marginal");
  EXPECT_EQ(section.at("marks").size(), 5u);  // the paper's scenarios with this horizon
}

TEST(FeasibilityMap, LimitEndsAtTheFirstCellThatIsNotClear) {
  const tools::FeasibilityMap map = MadeUpMap();
  EXPECT_EQ(map.panels[0].clear(), 7);
  EXPECT_EQ(map.Limit(map.panels[0], 0), 0.3);
  EXPECT_EQ(map.Limit(map.panels[0], 1), 0.1);
  EXPECT_EQ(map.Limit(map.panels[0], 2), std::nullopt);
}

}  // namespace
