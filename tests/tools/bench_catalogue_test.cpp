#include "tools/bench/bench_catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "config/route_file.hpp"
#include "loop/config.hpp"
#include "sim/scenario.hpp"
#include "tools/bench/roadside_posts.hpp"

namespace {

using control::Obstacle;

const std::filesystem::path kCatalogue = LPVMPC_SOURCE_DIR "/scenarios/catalogue";

// A scenario and the road that its configuration names.
struct Road {
  explicit Road(const std::string& name)
      : scenario(sim::LoadScenario(kCatalogue / name / "scenario.toml")),
        route(config::LoadRoute(loop::LoadConfig(scenario.daemon_config).route)) {}

  sim::Scenario scenario;
  config::RouteFile route;
};

TEST(RoadsidePosts, StandBeyondTheEdgesByTurnsAheadOfTheVehicle) {
  const Road road("087-stop-at-end");  // straight along the X axis
  tools::RoadsidePosts posts(road.scenario, road.route);
  const std::vector<Obstacle> ahead = posts.Ahead({50.0, 0.0}, 32);
  ASSERT_EQ(ahead.size(), 32U);
  std::set<int> ids;
  for (std::size_t k = 0; k < ahead.size(); ++k) {
    const control::RoadBounds edges = road.route.road.At(ahead[k].X);
    const double beyond =
        ahead[k].Y > 0.0 ? ahead[k].Y - edges.left - ahead[k].r_y : edges.right - ahead[k].Y - ahead[k].r_y;
    EXPECT_NEAR(beyond, 0.3, 1e-9);
    EXPECT_NEAR(ahead[k].X, 48.75 + 1.25 * static_cast<double>(k), 1e-6);
    if (k > 0) {
      EXPECT_LT(ahead[k].Y * ahead[k - 1].Y, 0.0);
    }
    ids.insert(ahead[k].id);
  }
  EXPECT_EQ(ids.size(), 32U);
  EXPECT_EQ(posts.Ahead({51.0, 0.0}, 32)[0].id, ahead[1].id) << "a post keeps its id";
}

TEST(RoadsidePosts, TakeNoIdOfTheScenarioAndNoMoreThanItLeaves) {
  const Road road("056-forty-objects");
  tools::RoadsidePosts posts(road.scenario, road.route);
  const std::vector<Obstacle> ahead = posts.Ahead({20.0, 0.0}, 64);
  EXPECT_EQ(ahead.size(), 24U);
  for (const Obstacle& post : ahead) {
    EXPECT_TRUE(std::ranges::find(road.scenario.obstacles, post.id, &Obstacle::id) ==
                road.scenario.obstacles.end());
  }
}

TEST(BenchCatalogue, TimesTheCyclesOfADriveAmongPosts) {
  std::ostringstream out;
  tools::BenchCatalogue({.folder = kCatalogue, .filter = "087", .repeat = 2, .json = true}, out);
  const auto figures = nlohmann::json::parse(out.str());
  EXPECT_EQ(figures.at("horizon"), 40);
  EXPECT_EQ(figures.at("objects"), 32);
  ASSERT_EQ(figures.at("scenarios").size(), 1U);
  const auto& line = figures.at("scenarios")[0];
  EXPECT_EQ(line.at("name"), "087-stop-at-end");
  EXPECT_EQ(line.at("passed"), true);
  EXPECT_GT(line.at("cycles"), 200);
  EXPECT_GT(line.at("median_us"), 0.0);
  EXPECT_LE(line.at("median_us"), line.at("p99_us"));
  EXPECT_LE(line.at("p99_us"), line.at("max_us"));
  EXPECT_EQ(figures.at("all").at("cycles"), line.at("cycles"));
}

TEST(BenchCatalogue, NamesAFilterThatFindsNothing) {
  std::ostringstream out;
  EXPECT_THROW(tools::BenchCatalogue({.folder = kCatalogue, .filter = "no such"}, out),
               std::invalid_argument);
}

}  // namespace
