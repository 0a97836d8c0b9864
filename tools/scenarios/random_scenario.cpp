#include "tools/scenarios/random_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "control/road/projection.hpp"
#include "tools/scenarios/random.hpp"
#include "tools/scenarios/traffic_scenario.hpp"

namespace tools {
namespace {

using control::PassingSide;

constexpr double kShortest = 7.5, kLongest = 9.0;  // duration of a drive at the target speed [s]
constexpr double kSpacing = 2.5;                   // least time before each encounter [s]
constexpr double kAfterLast = 0.8;                 // least time from the last encounter to the end [s]
constexpr double kRunOut = 4.0;           // extension of the controller's road past the scenario's end [s]
constexpr double kLateralShare = 0.35;    // share of μ g that the road's bends need at most
constexpr double kSharpest = 1.0 / 30.0;  // curvature [1/m]
constexpr double kMostExcess = 1.0;       // over the target speed [m/s]
constexpr control::RoadBounds kRoad{.left = 4.0, .right = -4.0};
// The start: no road reaches the map's bounds from here.
constexpr double kStartX = 0.5 * (sim::kMapMinX + sim::kMapMaxX),
                 kStartY = 0.5 * (sim::kMapMinY + sim::kMapMaxY);
static_assert((kLongest + kRunOut) * kSpeedLimits.high < kStartX - sim::kMapMinX - 50.0);

// Appends a bend that begins and ends straight, within `length` [m].
void AddBend(Random& random, double length, double curvature, std::vector<control::RoutePiece>& pieces) {
  const double in = random.Uniform(0.2, 0.35) * length, out = random.Uniform(0.2, 0.35) * length;
  const double straight = random.Uniform(0.01, 0.15) * length;
  pieces.push_back({.length = in, .curvature_from = 0.0, .curvature_to = curvature});
  pieces.push_back(
      {.length = length - in - out - straight, .curvature_from = curvature, .curvature_to = curvature});
  pieces.push_back({.length = out, .curvature_from = curvature, .curvature_to = 0.0});
  pieces.push_back({.length = straight});
}

std::vector<control::RoutePiece> DrawRoad(Random& random, double speed, double duration, double lowest_mu) {
  const double sharpest = std::min(kSharpest, kLateralShare * lowest_mu * sim::kGravity / (speed * speed));
  std::vector<control::RoutePiece> pieces{{.length = random.Uniform(0.5, 1.2) * speed}};
  double left = duration * speed - pieces.front().length;
  for (int bends = random.Integer(1, 3); bends > 0; --bends) {
    const double length = bends == 1 ? left : random.Uniform(0.7, 1.3) * left / bends;
    AddBend(random, length, random.Sign() * random.Uniform(0.2, 1.0) * sharpest, pieces);
    left -= length;
  }
  return pieces;
}

// An obstacle's velocity along the road and to its left [m/s]. Zero for two of three.
Eigen::Vector2d DrawVelocity(Random& random, double speed) {
  if (!random.Chance(1.0 / 3.0)) return {0.0, 0.0};
  if (random.Chance(0.5)) return {random.Sign() * random.Uniform(0.02, 0.25) * speed, 0.0};
  return {0.0, random.Sign() * random.Uniform(0.2, 1.0)};
}

// An obstacle that a vehicle with the target speed meets at time `at`.
control::Obstacle DrawObstacle(Random& random, const control::Route& route, double speed, double at) {
  const control::RoutePoint point = route.At(at * speed);
  const double lateral = random.Uniform(-2.2, 2.2);
  const Eigen::Vector2d centre = control::Beside(point, lateral);
  control::Obstacle obstacle{
      .X = centre.x(),
      .Y = centre.y(),
      .r_x = random.Uniform(0.5, 1.5),
      .r_y = random.Uniform(0.5, 1.5),
      .heading = random.Uniform(-0.5 * std::numbers::pi, 0.5 * std::numbers::pi),
  };
  const Eigen::Vector2d velocity = DrawVelocity(random, speed);
  obstacle.velocity_X = velocity.x() * std::cos(point.psi) - velocity.y() * std::sin(point.psi);
  obstacle.velocity_Y = velocity.x() * std::sin(point.psi) + velocity.y() * std::cos(point.psi);
  // Moves it back to its position at the start.
  obstacle.X -= obstacle.velocity_X * at;
  obstacle.Y -= obstacle.velocity_Y * at;
  if (random.Chance(0.5)) obstacle.side = lateral < 0.0 ? PassingSide::kLeft : PassingSide::kRight;
  return obstacle;
}

void DrawObstacles(Random& random, double duration, std::size_t count, sim::Scenario& scenario) {
  const double speed = scenario.route.At(0.0).speed;
  const double slack = duration - static_cast<double>(count) * kSpacing - kAfterLast;
  std::vector<double> shares(count);
  for (double& share : shares) share = random.Uniform(0.0, 1.0);
  std::ranges::sort(shares);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = static_cast<double>(i + 1) * kSpacing + shares[i] * slack;
    control::Obstacle obstacle = DrawObstacle(random, scenario.route, speed, at);
    obstacle.id = static_cast<int>(i) + 1;
    scenario.obstacles.push_back(obstacle);
    if (random.Chance(0.2)) scenario.appears_at[obstacle.id] = at - random.Uniform(2.0, 2.5);
  }
}

std::string Describe(const sim::Scenario& scenario, const DrawnVehicle& vehicle) {
  const auto moving = std::ranges::count_if(scenario.obstacles, [](const control::Obstacle& obstacle) {
    return obstacle.velocity_X != 0.0 || obstacle.velocity_Y != 0.0;
  });
  std::string text =
      fmt::format("{:.1f} m/s, mu {:.2f}, {} obstacle{}", scenario.route.At(0.0).speed, scenario.plant.mu,
                  scenario.obstacles.size(), scenario.obstacles.size() == 1 ? "" : "s");
  if (moving > 0) text += fmt::format(", {} moving", moving);
  if (!scenario.appears_at.empty()) text += fmt::format(", {} late", scenario.appears_at.size());
  return text + ", " + Describe(vehicle);
}

}  // namespace

RandomScenario DrawScenario(std::uint64_t seed, const ScenarioRanges& ranges) {
  if (ranges.traffic) return DrawTraffic(PointOf(seed), ranges);
  Random random(seed);
  const double speed = random.Uniform(ranges.speed.low, ranges.speed.high);
  const int obstacles = random.Integer(1, 3);
  const double duration =
      random.Uniform(std::max(kShortest, obstacles * kSpacing + kAfterLast + 0.2), kLongest);
  const control::RouteStart start{
      .X = kStartX, .Y = kStartY, .psi = random.Uniform(-std::numbers::pi, std::numbers::pi)};
  std::vector<control::RoutePiece> pieces = DrawRoad(random, speed, duration, ranges.mu.low);

  sim::Scenario scenario(control::Route::FromPieces(start, speed, pieces), kRoad);
  scenario.name = fmt::format("sweep scenario {}", seed);
  scenario.seed = seed;
  const DrawnVehicle vehicle = DrawVehicle(random, ranges.mu);
  Equip(vehicle, scenario);
  scenario.PlaceVehicle(0.0, random.Uniform(0.9, 1.1) * speed, random.Uniform(-0.8, 0.8),
                        random.Uniform(-0.03, 0.03));
  DrawObstacles(random, duration, static_cast<std::size_t>(obstacles), scenario);
  scenario.description = Describe(scenario, vehicle);
  scenario.expect.min_clearance_m = 0.0;
  scenario.expect.min_road_margin_m = 0.0;
  scenario.expect.max_speed_excess_mps = kMostExcess;

  pieces.push_back({.length = kRunOut * speed});
  return {.scenario = std::move(scenario),
          .route = {.route = control::Route::FromPieces(start, speed, pieces), .road = kRoad}};
}

}  // namespace tools
