#include "tools/scenarios/traffic_scenario.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string>
#include <utility>
#include <vector>

#include "tools/scenarios/drawn_vehicle.hpp"
#include "tools/scenarios/point_reader.hpp"
#include "tools/scenarios/traffic_objects.hpp"
#include "tools/scenarios/traffic_road.hpp"

namespace tools {
namespace {

constexpr double kDegree = 0.0174533;  // [rad]

// Places the vehicle on the scenario's road.
void Place(PointReader& reader, sim::Scenario& scenario) {
  const double speed = reader.Uniform(0.9, 1.0) * scenario.route.At(0.0).speed;
  const double share = reader.Uniform(-0.5, 0.5), heading = reader.Uniform(-0.02, 0.02);
  const control::RoadBounds road = scenario.road.At(0.0);
  const double room = std::min({road.left, -road.right, 2.0}) - scenario.footprint.half_width;
  scenario.PlaceVehicle(0.0, speed, share * room, heading);
}

// What acts on the vehicle besides its inputs, in words.
std::string Disturb(PointReader& reader, double duration, sim::PlantParameters& plant) {
  std::string text;
  const bool offset = reader.Chance(0.2);
  const double steering_offset = reader.Uniform(-1.0, 1.0) * kDegree;
  const bool banked = reader.Chance(0.2);
  const double bank = reader.Uniform(-0.05, 0.05);
  const bool windy = reader.Chance(1.0 / 6.0);
  const double from = reader.Uniform(0.0, duration), gust = reader.Uniform(-1.0, 1.0);
  if (offset) {
    plant.steering_offset = steering_offset;
    text += fmt::format(", steering offset {:.1f} deg", steering_offset / kDegree);
  }
  if (banked) {
    plant.bank = bank;
    text += fmt::format(", bank {:.0f} %", 100.0 * bank);
  }
  if (windy) {
    plant.wind = {.from = from, .until = from + 2.0, .lateral_acceleration = gust};
    text += fmt::format(", gust {:.1f} m/s2", gust);
  }
  return text;
}

}  // namespace

RandomScenario DrawTraffic(const TrafficPoint& point, const ScenarioRanges& ranges) {
  PointReader reader(point);
  PointReader of_vehicle = reader.Block(kVehicleCoordinates);
  const DrawnVehicle vehicle = DrawVehicle(of_vehicle, ranges.mu);
  const TrafficRoad road = DrawTrafficRoad(reader.Block(kRoadCoordinates), ranges.speed, vehicle.mu);

  sim::Scenario scenario(road.route, road.edges);
  scenario.name = "traffic";
  Equip(vehicle, scenario);
  Place(of_vehicle, scenario);
  const std::string disturbed = Disturb(of_vehicle, road.route.duration(), scenario.plant);
  std::vector<std::string> things{fmt::format("{}, mu {:.2f}", road.description, vehicle.mu)};
  const auto add = [&](std::size_t count, std::size_t coordinates, const auto& draw) {
    for (std::size_t i = 0; i < count; ++i) {
      std::string text = draw(reader.Block(coordinates), scenario);
      if (!text.empty()) things.push_back(std::move(text));
    }
  };
  add(1, kFollowerCoordinates, AddFollower);
  add(1, kLeaderCoordinates, AddLeader);
  add(kOncoming, kOncomingCoordinates, AddOncoming);
  add(kCrossing, kCrossingCoordinates, AddCrossing);
  add(1, kGroupCoordinates, AddGroup);
  add(1, kBesideCoordinates, AddBeside);
  add(kParked, kParkedCoordinates, AddParked);
  things.push_back(Describe(vehicle) + disturbed);
  scenario.description = fmt::format("{}", fmt::join(things, "; "));

  scenario.expect.min_clearance_m = 0.0;
  scenario.expect.min_road_margin_m = 0.0;
  scenario.expect.max_speed_excess_mps = 1.0;
  scenario.expect.max_end_overshoot_m = 0.3;
  return {.scenario = std::move(scenario), .route = {.route = road.route, .road = road.edges}};
}

}  // namespace tools
