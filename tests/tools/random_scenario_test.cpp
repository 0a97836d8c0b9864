#include "tools/scenarios/random_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

#include "tools/scenarios/encounter.hpp"
#include "tools/scenarios/scenario_seed.hpp"

namespace {

using tools::DrawScenario;
using tools::RandomScenario;
using tools::ScenarioRanges;

constexpr int kDrawn = 300;
constexpr ScenarioRanges kRanges{.speed = {3.0, 40.0}, .mu = {0.3, 1.2}};

template <typename Look>
void ForEach(const ScenarioRanges& ranges, const Look& look) {
  for (int i = 0; i < kDrawn; ++i) {
    const std::uint64_t seed = tools::ScenarioSeed(7, static_cast<std::uint64_t>(i));
    SCOPED_TRACE(seed);
    look(DrawScenario(seed, ranges));
  }
}

TEST(ScenarioSeed, IsTheOutputOfSplitMix64) {
  // Outputs of the published generator with state 1234567.
  EXPECT_EQ(tools::ScenarioSeed(1234567, 0), 6457827717110365317u >> 11);
  EXPECT_EQ(tools::ScenarioSeed(1234567, 1), 3203168211198807973u >> 11);
  EXPECT_EQ(tools::ScenarioSeed(1234567, 4), 16408922859458223821u >> 11);
}

TEST(ScenarioSeed, EachScenarioOfEachSweepHasItsOwn) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t sweep = 0; sweep < 20; ++sweep) {
    for (std::uint64_t index = 0; index < 500; ++index) seeds.insert(tools::ScenarioSeed(sweep, index));
  }
  EXPECT_EQ(seeds.size(), 20u * 500u);
  EXPECT_LT(*seeds.rbegin(), tools::kSeedEnd);
}

TEST(RandomScenario, IsThatOfItsSeedAlone) {
  const RandomScenario a = DrawScenario(5, kRanges), b = DrawScenario(5, kRanges),
                       c = DrawScenario(6, kRanges);
  EXPECT_EQ(a.scenario.description, b.scenario.description);
  EXPECT_EQ(a.scenario.initial, b.scenario.initial);
  EXPECT_EQ(a.scenario.obstacles.size(), b.scenario.obstacles.size());
  EXPECT_NE(a.scenario.initial, c.scenario.initial);
}

// The figures of one seed are fixed, so that a dependence on the standard library would be noticed.
TEST(RandomScenario, IsTheSameWithAnyLibrary) {
  const RandomScenario drawn = DrawScenario(1, {.speed = {8.0, 20.0}, .mu = {0.4, 1.0}});
  EXPECT_EQ(
      drawn.scenario.description,
      "9.6 m/s, mu 0.73, 1 obstacle, 1 moving, mass x 1.12, steering lag 25 ms, delay 1 cycle, noise 29 %");
}

TEST(RandomScenario, KeepsToTheRanges) {
  ForEach(kRanges, [](const RandomScenario& drawn) {
    const sim::Scenario& scenario = drawn.scenario;
    const double speed = scenario.route.At(0.0).speed;
    EXPECT_GE(speed, 3.0);
    EXPECT_LE(speed, 40.0);
    EXPECT_GE(scenario.plant.mu, 0.3);
    EXPECT_LE(scenario.plant.mu, 1.2);
    EXPECT_GE(scenario.route.duration(), 7.5 - 1e-9);
    EXPECT_LE(scenario.route.duration(), 9.0 + 1e-9);
    EXPECT_NEAR(scenario.initial[control::kUpsilon] / speed, 1.0, 0.1);
    const control::RouteProjection start =
        scenario.route.Project({scenario.initial[control::kX], scenario.initial[control::kY]});
    EXPECT_LE(std::abs(start.lateral), 0.8 + 1e-9);
    EXPECT_NEAR(start.s, 0.0, 1e-6);
    EXPECT_EQ(scenario.footprint.front + scenario.footprint.rear, 4.25);
  });
}

TEST(RandomScenario, RoadBendsBothWaysInsideTheMapAndLeavesFrictionToSpare) {
  double left = 0.0, right = 0.0;
  ForEach(kRanges, [&](const RandomScenario& drawn) {
    const control::Route& route = drawn.route.route;
    for (double s = 0.0; s <= route.length(); s += 0.5) {
      const control::RoutePoint at = route.At(s);
      ASSERT_GT(at.X, sim::kMapMinX + 50.0);
      ASSERT_LT(at.X, sim::kMapMaxX - 50.0);
      ASSERT_GT(at.Y, sim::kMapMinY + 50.0);
      ASSERT_LT(at.Y, sim::kMapMaxY - 50.0);
      ASSERT_EQ(at.speed, route.At(0.0).speed);
      const double share = at.curvature * at.speed * at.speed / (0.3 * 9.81);
      left = std::max(left, share);
      right = std::min(right, share);
    }
  });
  EXPECT_LE(left, 0.35 + 1e-9);
  EXPECT_GE(right, -0.35 - 1e-9);
  EXPECT_GT(left, 0.3);
  EXPECT_LT(right, -0.3);
}

TEST(RandomScenario, ControllersRoadGoesOnWhereTheScenarioEnds) {
  ForEach(kRanges, [](const RandomScenario& drawn) {
    const control::Route &scenario = drawn.scenario.route, &route = drawn.route.route;
    EXPECT_NEAR(route.duration() - scenario.duration(), 4.0, 1e-9);
    for (const double share : {0.0, 0.4, 1.0}) {
      const control::RoutePoint a = scenario.At(share * scenario.length()),
                                b = route.At(share * scenario.length());
      EXPECT_NEAR(std::hypot(a.X - b.X, a.Y - b.Y), 0.0, 1e-9);
    }
  });
}

TEST(RandomScenario, ObstaclesAreMetOnTheRoadWithTimeBetweenThem) {
  ForEach(kRanges, [](const RandomScenario& drawn) {
    const auto encounters = tools::Encounters(drawn.scenario);
    ASSERT_EQ(encounters.size(), drawn.scenario.obstacles.size());
    double before = 0.0;
    for (const tools::Encounter& met : encounters) {
      EXPECT_GE(met.time - before, 2.5 - 1e-4);
      EXPECT_LE(std::abs(met.lateral), 2.2 + 1e-4);
      if (met.perceived_at > 0.0) {
        EXPECT_GE(met.time - met.perceived_at, 2.0 - 1e-4);
        EXPECT_LE(met.time - met.perceived_at, 2.5 + 1e-4);
      }
      if (met.obstacle.side == control::PassingSide::kLeft) {
        EXPECT_LT(met.lateral, 1e-4);
      }
      if (met.obstacle.side == control::PassingSide::kRight) {
        EXPECT_GT(met.lateral, -1e-4);
      }
      before = met.time;
    }
    EXPECT_LE(before, drawn.scenario.route.duration() - 0.8 + 1e-4);
  });
}

TEST(RandomScenario, MovingLateAndUnsidedObstaclesAreAsOftenAsIsSaid) {
  double all = 0.0, moving = 0.0, across = 0.0, late = 0.0, sided = 0.0;
  ForEach(kRanges, [&](const RandomScenario& drawn) {
    const double speed = drawn.scenario.route.At(0.0).speed;
    for (const tools::Encounter& met : tools::Encounters(drawn.scenario)) {
      const double v = std::hypot(met.obstacle.velocity_X, met.obstacle.velocity_Y);
      ++all;
      moving += static_cast<double>(v > 0.0);
      across += static_cast<double>(v > 0.1 && std::abs(met.velocity_along) < 1e-3 * v);
      late += static_cast<double>(met.perceived_at > 0.0);
      sided += static_cast<double>(met.obstacle.side != control::PassingSide::kUnknown);
      EXPECT_LE(v, std::max(0.25 * speed, 1.0) + 1e-9);
    }
  });
  EXPECT_NEAR(all / kDrawn, 2.0, 0.15);
  EXPECT_NEAR(moving / all, 1.0 / 3.0, 0.07);
  EXPECT_NEAR(across / all, 1.0 / 6.0, 0.06);
  EXPECT_NEAR(late / all, 0.2, 0.06);
  EXPECT_NEAR(sided / all, 0.5, 0.07);
}

TEST(RandomScenario, TellsWhatWasDrawnInOneLine) {
  ForEach(kRanges, [](const RandomScenario& drawn) {
    EXPECT_EQ(drawn.scenario.description.find('\n'), std::string::npos);
    EXPECT_NE(drawn.scenario.description.find(" m/s, mu "), std::string::npos);
  });
}

}  // namespace
