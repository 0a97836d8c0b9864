#include "tools/scenarios/traffic_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "control/road/keep_out.hpp"
#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "sim/footprint_distance.hpp"
#include "sim/road_body.hpp"
#include "sim/traffic.hpp"
#include "tools/scenarios/point_reader.hpp"
#include "tools/scenarios/scenario_seed.hpp"

namespace {

using testing::HasSubstr;
using tools::RandomScenario;
using tools::ScenarioRanges;
using tools::TrafficPoint;

constexpr int kDrawn = 300;
constexpr ScenarioRanges kRanges{.speed = {3.0, 40.0}, .mu = {0.3, 1.2}, .traffic = true};

template <typename Look>
void ForEach(const Look& look) {
  for (int i = 0; i < kDrawn; ++i) {
    const std::uint64_t seed = tools::ScenarioSeed(5, static_cast<std::uint64_t>(i));
    SCOPED_TRACE(seed);
    look(tools::DrawScenario(seed, kRanges));
  }
}

TEST(PointReader, MapsEachCoordinateToWhatIsAsked) {
  const std::array point{0.0, 0.25, 0.999, 0.5, 0.49, 0.1};
  tools::PointReader reader(point);
  EXPECT_EQ(reader.Uniform(2.0, 4.0), 2.0);
  EXPECT_EQ(reader.Uniform(2.0, 4.0), 2.5);
  EXPECT_EQ(reader.Integer(4, 12), 12);
  EXPECT_FALSE(reader.Chance(0.5));
  EXPECT_TRUE(reader.Chance(0.5));
  EXPECT_EQ(reader.Sign(), 1.0);
  EXPECT_THROW((void)reader.Sign(), std::out_of_range);
}

TEST(PointReader, WhatABlockLeavesUnreadIsSkipped) {
  const std::array point{0.1, 0.2, 0.3, 0.4};
  tools::PointReader reader(point);
  tools::PointReader block = reader.Block(3);
  EXPECT_EQ(block.Uniform(0.0, 1.0), 0.1);
  EXPECT_EQ(reader.Uniform(0.0, 1.0), 0.4);
  EXPECT_THROW((void)reader.Block(1), std::out_of_range);
}

TEST(TrafficPointTest, HasAKeyThatNamesItOnTheGrid) {
  const TrafficPoint point = tools::PointOf(std::uint64_t{3}), grid = tools::OnGrid(point);
  const std::string key = tools::KeyOf(point);
  EXPECT_EQ(key.size(), 2 * tools::kTrafficDimensions);
  EXPECT_EQ(tools::PointOf(key), grid);
  EXPECT_EQ(tools::KeyOf(grid), key);
  for (std::size_t i = 0; i < point.size(); ++i) EXPECT_NEAR(grid[i], point[i], 0.5 / 4096);
  EXPECT_EQ(tools::DrawTraffic(tools::PointOf(key), kRanges).scenario.description,
            tools::DrawTraffic(grid, kRanges).scenario.description);
}

TEST(TrafficPointTest, TextThatIsNoKeyIsRefused) {
  std::string key = tools::KeyOf(tools::PointOf(std::uint64_t{3}));
  EXPECT_THROW((void)tools::PointOf(key.substr(1)), std::invalid_argument);
  key[7] = '-';
  try {
    (void)tools::PointOf(key);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "--traffic-key: '-' is no digit of a key");
  }
}

TEST(TrafficScenario, IsThatOfItsSeedAlone) {
  const RandomScenario a = tools::DrawScenario(5, kRanges), b = tools::DrawScenario(5, kRanges);
  EXPECT_EQ(a.scenario.description, b.scenario.description);
  EXPECT_EQ(a.scenario.initial, b.scenario.initial);
  EXPECT_NE(a.scenario.initial, tools::DrawScenario(6, kRanges).scenario.initial);
}

TEST(TrafficScenario, CoordinatesAreAllRead) {
  // Of the last object, a parked vehicle: each of its coordinates but those of what is not there changes the scenario.
  TrafficPoint point = tools::PointOf(std::uint64_t{1});
  const std::size_t parked = tools::kTrafficDimensions - tools::kParkedCoordinates;
  point[parked] = 0.0;  // present
  const auto drawn = [&] { return tools::DrawTraffic(point, kRanges).scenario; };
  const sim::Scenario before = drawn();
  point[tools::kTrafficDimensions - 2] = 0.999 - point[tools::kTrafficDimensions - 2];  // its heading
  const sim::Scenario after = drawn();
  ASSERT_EQ(before.obstacles.size(), after.obstacles.size());
  EXPECT_NE(before.obstacles.back().heading, after.obstacles.back().heading);
  EXPECT_EQ(before.obstacles.back().X, after.obstacles.back().X);
}

TEST(TrafficScenario, RoadStaysInTheMapAndNeedsNoMoreThanGripAllows) {
  int slows = 0, narrows = 0;
  double most = 0.0;
  ForEach([&](const RandomScenario& drawn) {
    const control::Route& route = drawn.scenario.route;
    EXPECT_LE(route.length(), 600.0 + 1e-6);
    double slowest = 1e9, narrowest = 1e9;
    for (double s = 0.0; s <= route.length(); s += 0.5) {
      const control::RoutePoint at = route.At(s);
      ASSERT_GT(at.X, sim::kMapMinX + 50.0);
      ASSERT_LT(at.X, sim::kMapMaxX - 50.0);
      ASSERT_GT(at.Y, sim::kMapMinY + 50.0);
      ASSERT_LT(at.Y, sim::kMapMaxY - 50.0);
      const double share = std::abs(at.curvature) * at.speed * at.speed / (9.81 * drawn.scenario.plant.mu);
      ASSERT_LE(share, 0.801) << s;
      most = std::max(most, share);
      const double change = route.At(s + 0.01).speed - at.speed;  // a = v dv/ds
      ASSERT_LE(std::abs(change) / 0.01 * at.speed, 0.36 * 9.81 * drawn.scenario.plant.mu) << s;
      const control::RoadBounds road = drawn.scenario.road.At(s);
      ASSERT_GE(road.left, 1.05 - 1e-9);
      ASSERT_LE(road.right, -1.05 + 1e-9);
      slowest = std::min(slowest, at.speed);
      narrowest = std::min(narrowest, road.left - road.right);
    }
    slows += static_cast<int>(slowest < 0.9 * route.At(0.0).speed);
    narrows += static_cast<int>(narrowest < 3.0);
  });
  EXPECT_GT(most, 0.75);
  EXPECT_GT(slows, kDrawn / 10);
  EXPECT_GT(narrows, kDrawn / 20);
}

TEST(TrafficScenario, RoadDoesNotMeetItself) {
  ForEach([](const RandomScenario& drawn) {
    const control::Route& route = drawn.scenario.route;
    for (double s = 0.0; s + 40.0 < route.length(); s += 10.0) {
      const control::RoutePoint at = route.At(s);
      for (double ahead = s + 40.0; ahead < route.length(); ahead += 2.0) {
        const control::RoutePoint there = route.At(ahead);
        ASSERT_GT(std::hypot(at.X - there.X, at.Y - there.Y), 20.0) << s << " and " << ahead;
      }
    }
  });
}

TEST(TrafficScenario, VehicleStartsOnTheRoadAtNoMoreThanTheTargetSpeed) {
  ForEach([](const RandomScenario& drawn) {
    const sim::Scenario& scenario = drawn.scenario;
    EXPECT_LE(scenario.initial[control::kUpsilon], scenario.route.At(0.0).speed);
    const control::RouteProjection place = scenario.route.Project(control::Position(scenario.initial));
    const sim::RoadBody body =
        sim::VehicleOnRoad(scenario.initial, scenario.footprint, scenario.route, place);
    const control::RoadBounds road = scenario.road.At(0.0);
    EXPECT_LT(body.left, road.left);
    EXPECT_GT(body.right, road.right);
  });
}

// An object's rectangle on the road, from the nearest point of the route.
sim::RoadBody OnRoad(const sim::Scenario& scenario, const control::Obstacle& object) {
  return sim::ObjectOnRoad(object, scenario.route, scenario.route.Project({object.X, object.Y}));
}

TEST(TrafficScenario, ObjectsAreApartFromTheVehicleAtTheStart) {
  ForEach([](const RandomScenario& drawn) {
    const sim::Scenario& scenario = drawn.scenario;
    std::set<int> ids;
    for (const control::Obstacle& object : scenario.obstacles) {
      EXPECT_TRUE(ids.insert(object.id).second);
      EXPECT_LT(object.id, 64);
      EXPECT_GT(sim::FootprintDistance(object, scenario.footprint, control::Position(scenario.initial),
                                       scenario.initial[control::kPsi]),
                0.1)
          << object.id;
      EXPECT_LT(std::max(std::abs(object.X), std::abs(object.Y)), 2000.0) << "the bus has no room for it";
    }
  });
}

TEST(TrafficScenario, NothingIsPerceivedLaterThanASecondBeforeItIsMet) {
  int late = 0, early = 0;
  ForEach([&](const RandomScenario& drawn) {
    const sim::Scenario& scenario = drawn.scenario;
    for (const control::Obstacle& object : scenario.obstacles) {
      if (object.velocity_X != 0.0 || object.velocity_Y != 0.0)
        continue;  // of those that stand, the place is known
      const auto appears = scenario.appears_at.find(object.id);
      const double s = OnRoad(scenario, object).s;
      double met = 0.0;
      while (scenario.route.ArcLengthAt(met) < s) met += 0.05;
      const double notice = appears == scenario.appears_at.end() ? met : met - appears->second;
      EXPECT_GE(notice, std::min(met, 1.0) - 0.1);
      (notice < 4.0 ? late : early) += 1;
    }
  });
  EXPECT_GT(late, 50);
  EXPECT_GT(early, 50);
}

TEST(TrafficScenario, WhatIsBesideTheRoadIsBesideIt) {
  int seen = 0;
  ForEach([&](const RandomScenario& drawn) {
    const sim::Scenario& scenario = drawn.scenario;
    if (scenario.description.find("beside the road") == std::string::npos) return;
    // The description names their number; they are the only objects that cover nothing of the road from the start.
    int beside = 0;
    for (const control::Obstacle& object : scenario.obstacles) {
      const sim::RoadBody body = OnRoad(scenario, object);
      const control::RoadBounds road = scenario.road.At(body.s);
      beside += static_cast<int>(body.right > road.left || body.left < road.right);
    }
    EXPECT_GE(beside, 1);
    ++seen;
  });
  EXPECT_GT(seen, kDrawn / 5);
}

TEST(TrafficScenario, EveryKindIsDrawnAndTold) {
  std::map<std::string, int> told;
  ForEach([&](const RandomScenario& drawn) {
    const std::string& text = drawn.scenario.description;
    EXPECT_EQ(text.find('\n'), std::string::npos);
    for (const char* kind :
         {"that follows", " ahead at ", "that brakes", "that comes", "that crosses", "that leave",
          "beside the road", "parked ", "two lanes", "wide lane", "narrow street", "steering offset", "bank",
          "gust", "lorry", "cycle", "pedestrian", "seen 1.", "and yields"}) {
      told[kind] += static_cast<int>(text.find(kind) != std::string::npos);
    }
  });
  for (const auto& [kind, count] : told) EXPECT_GT(count, kind == "and yields" ? 0 : 15) << kind;
}

TEST(TrafficScenario, OncomingTrafficLeavesRoomOrYields) {
  int coming = 0, yielding = 0;
  ForEach([&](const RandomScenario& drawn) {
    const sim::Scenario& scenario = drawn.scenario;
    for (const auto& [id, motion] : scenario.motions) {
      if (motion.speed.front().speed >= 0.0) continue;
      ++coming;
      yielding += static_cast<int>(motion.follows);
      if (motion.follows) continue;
      const double right =
          motion.lateral.front().lateral - scenario.obstacles[static_cast<std::size_t>(id)].r_y;
      for (double s = 0.0; s < scenario.route.length(); s += 1.0)
        ASSERT_GE(right - scenario.road.At(s).right, 1.8 + 0.9 - 1e-9) << s;
    }
  });
  EXPECT_GT(coming, kDrawn / 2);
  EXPECT_GT(yielding, 0);
  EXPECT_LT(yielding, coming / 2);
}

// A vehicle that keeps the target speed on a straight road is not touched by who follows.
TEST(TrafficScenario, FollowerDoesNotRunIntoAVehicleThatKeepsItsSpeed) {
  int followers = 0;
  ForEach([&](const RandomScenario& drawn) {
    sim::Scenario scenario = drawn.scenario;
    std::erase_if(scenario.obstacles, [&](const control::Obstacle& object) {
      const auto motion = scenario.motions.find(object.id);
      return motion == scenario.motions.end() || !motion->second.follows ||
             motion->second.speed[0].speed < 0.0;
    });
    if (scenario.obstacles.empty()) return;
    ++followers;
    sim::Traffic traffic(scenario);
    const double speed = scenario.initial[control::kUpsilon];
    control::State z = scenario.initial;
    for (int k = 0; speed * 0.05 * k < scenario.route.length(); ++k) {
      const control::RoutePoint at = scenario.route.At(speed * 0.05 * k);
      z[control::kX] = at.X;
      z[control::kY] = at.Y;
      z[control::kPsi] = at.psi;
      traffic.Advance(0.05 * (k + 1), z);
      const control::Obstacle behind = traffic.Now().front();
      const Eigen::Vector2d gap(behind.X - at.X, behind.Y - at.Y);
      ASSERT_GT(gap.norm(), 2.3 + behind.r_x - 0.3) << k;
    }
  });
  EXPECT_GT(followers, kDrawn / 5);
}

TEST(TrafficScenario, ControllersRoadEndsWhereTheScenarioDoes) {
  ForEach([](const RandomScenario& drawn) {
    EXPECT_EQ(drawn.route.route.length(), drawn.scenario.route.length());
    EXPECT_EQ(drawn.scenario.expect.max_end_overshoot_m, 0.3);
  });
}

}  // namespace
