#include "sim/scenario.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <string_view>

#include "config/route_file.hpp"
#include "config/toml_table.hpp"
#include "control/road/projection.hpp"
#include "sim/motion_table.hpp"

namespace sim {
namespace {

using config::Range;
using config::TomlTable;

constexpr Range<double> kMapX{kMapMinX, kMapMaxX};
constexpr Range<double> kMapY{kMapMinY, kMapMaxY};
constexpr Range<double> kSemiAxis{0.05, 20.0};  // within the range of ObstacleObject [m]
constexpr Range<double> kFactor{0.2, 5.0};
constexpr Range<double> kOverhang{0.0, 20.0};     // [m]
constexpr Range<double> kWidth{0.0, 10.0};        // [m]
constexpr Range<double> kInclination{-0.3, 0.3};  // of the road [rad]
constexpr Range<int> kObjectId{0, 63};            // of ObstacleObject

const std::array<std::string_view, 2> kByMap{"X", "Y"};

// Names in the order of control::PassingSide.
std::vector<std::string> SideNames() {
  return {"unknown", "left", "right"};
}

// Names in the order of control::ObstacleShape.
std::vector<std::string> ShapeNames() {
  return {"ellipse", "box"};
}

// Names in the order of control::ObstacleClass.
std::vector<std::string> ClassNames() {
  return {"unknown", "static", "vehicle", "cycle", "pedestrian"};
}

void PlaceInMap(const TomlTable& table, control::Obstacle& obstacle) {
  if (table.Has("lateral")) throw table.Error("lateral", "must not be given without s");
  obstacle.X = table.Number("X", kMapX, "m");
  obstacle.Y = table.Number("Y", kMapY, "m");
}

void PlaceOnRoute(const TomlTable& table, const control::Route& route, control::Obstacle& obstacle) {
  for (const std::string_view key : kByMap) {
    if (table.Has(key)) throw table.Error(key, "must not be given along with s");
  }
  const control::RoutePoint point = route.At(table.Number("s", {0.0, route.length()}, "m"));
  const double lateral = table.NumberOr("lateral", 0.0, kObstacleLateral, "m");
  const Eigen::Vector2d centre = control::Beside(point, lateral);
  obstacle.X = centre.x();
  obstacle.Y = centre.y();
  obstacle.heading = control::WrapAngle(obstacle.heading + point.psi);
  const auto check = [&](const char* axis, double value, const Range<double>& range) {
    if (value >= range.min && value <= range.max) return;
    throw table.Error("s", fmt::format("puts the obstacle at {} = {:.1f}, outside [{}, {}] m", axis, value,
                                       range.min, range.max));
  };
  check("X", obstacle.X, kMapX);
  check("Y", obstacle.Y, kMapY);
}

control::Obstacle ReadObstacle(const TomlTable& table, const control::Route& route) {
  control::Obstacle obstacle;
  obstacle.id = table.Integer("id", kObjectId);
  obstacle.r_x = table.Number("r_x", kSemiAxis, "m");
  obstacle.r_y = table.Number("r_y", kSemiAxis, "m");
  obstacle.heading = control::WrapAngle(table.NumberOr("heading", 0.0, kObstacleHeading, "rad"));
  obstacle.velocity_X = table.NumberOr("velocity_X", 0.0, kObstacleSpeed, "m/s");
  obstacle.velocity_Y = table.NumberOr("velocity_Y", 0.0, kObstacleSpeed, "m/s");
  obstacle.side = static_cast<control::PassingSide>(table.ChoiceOr("side", 0, SideNames()));
  obstacle.shape = static_cast<control::ObstacleShape>(table.ChoiceOr("shape", 0, ShapeNames()));
  obstacle.object_class = static_cast<control::ObstacleClass>(table.ChoiceOr("class", 0, ClassNames()));
  if (table.Has("s")) {
    PlaceOnRoute(table, route, obstacle);
  } else {
    PlaceInMap(table, obstacle);
  }
  return obstacle;
}

// The obstacle starts as its motion says.
void ReadMotion(const TomlTable& table, control::Obstacle& obstacle, Scenario& scenario) {
  const auto motion = ReadRouteMotion(table, scenario.route);
  if (!motion) return;
  obstacle = OnRoute(obstacle, scenario.route, motion->heading, StateAt(*motion, 0.0));
  scenario.motions.emplace(obstacle.id, *motion);
}

void ReadPresence(const TomlTable& table, int id, Scenario& scenario) {
  const double appears = table.NumberOr("appears_at", 0.0, kScenarioTime, "s");
  if (table.Has("appears_at")) scenario.appears_at[id] = appears;
  if (!table.Has("disappears_at")) return;
  scenario.disappears_at[id] = table.Number("disappears_at", kScenarioTime, "s");
  if (scenario.disappears_at[id] <= appears)
    throw table.Error("disappears_at", fmt::format("must be later than {} s, when it appears", appears));
}

void ReadObstacles(const TomlTable& file, Scenario& scenario) {
  std::vector<control::Obstacle>& obstacles = scenario.obstacles;
  std::set<int> ids;
  for (const TomlTable& table : file.Tables("obstacle")) {
    obstacles.push_back(ReadObstacle(table, scenario.route));
    ReadMotion(table, obstacles.back(), scenario);
    ReadPresence(table, obstacles.back().id, scenario);
    if (!ids.insert(obstacles.back().id).second)
      throw table.Error("id", "is already used by another obstacle");
  }
}

Wind ReadWind(const TomlTable& table) {
  const Wind wind{.from = table.Number("from", kScenarioTime, "s"),
                  .until = table.Number("until", kScenarioTime, "s"),
                  .lateral_acceleration = table.Number("lateral_acceleration", {-5.0, 5.0}, "m/s^2")};
  if (wind.until <= wind.from) throw table.Error("until", "must be later than from");
  return wind;
}

void ReadDisturbances(const TomlTable& table, PlantParameters& plant) {
  plant.steering_offset = table.NumberOr("steering_offset", 0.0, {-0.1, 0.1}, "rad");
  plant.bank = table.NumberOr("bank", 0.0, kInclination, "rad");
  plant.slope = table.NumberOr("slope", 0.0, kInclination, "rad");
  if (table.Has("wind")) plant.wind = ReadWind(table.Table("wind"));
}

void ReadVehicle(const TomlTable& table, Scenario& scenario) {
  control::VehicleParameters& vehicle = scenario.plant.vehicle;
  const double mass_factor = table.NumberOr("mass_factor", 1.0, kFactor);
  vehicle.m *= mass_factor;
  vehicle.I_z *= mass_factor;
  vehicle.C_alpha_f *= table.NumberOr("front_stiffness_factor", 1.0, kFactor);
  vehicle.C_alpha_r *= table.NumberOr("rear_stiffness_factor", 1.0, kFactor);
  vehicle.driven = static_cast<control::DrivenAxle>(
      table.ChoiceOr("driven_axle", static_cast<std::size_t>(vehicle.driven), {"both", "front", "rear"}));
  scenario.plant.tyre = static_cast<Tyre>(table.ChoiceOr("tyre", 0, {"linear", "saturating"}));
  scenario.plant.mu = table.NumberOr("mu", scenario.plant.mu, {0.05, 2.0});
  ReadDisturbances(table, scenario.plant);
  scenario.footprint = {.front = table.NumberOr("front", 0.0, kOverhang, "m"),
                        .rear = table.NumberOr("rear", 0.0, kOverhang, "m"),
                        .half_width = 0.5 * table.NumberOr("width", 0.0, kWidth, "m")};

  const auto actuator = [&table](const std::string& name, double min, double max, const char* rate_unit) {
    ActuatorParameters parameters{.min = min, .max = max};
    parameters.time_constant = table.NumberOr(name + "_lag", 0.0, {0.0, 10.0}, "s");
    parameters.rate = table.NumberOr(name + "_rate", parameters.rate, {1e-3, 1e3}, rate_unit);
    parameters.delay_cycles = table.IntegerOr("delay_cycles", 0, {0, 100});
    return parameters;
  };
  scenario.steering = actuator("steering", -kSteeringStop, kSteeringStop, "rad/s");
  scenario.acceleration = actuator("acceleration", kHardestBraking, kStrongestAcceleration, "m/s^3");
}

SensorParameters ReadSensors(const TomlTable& table) {
  return {.position = table.NumberOr("position", 0.0, {0.0, 10.0}, "m"),
          .speed = table.NumberOr("speed", 0.0, {0.0, 10.0}, "m/s"),
          .heading = table.NumberOr("heading", 0.0, {0.0, 1.0}, "rad"),
          .yaw_rate = table.NumberOr("yaw_rate", 0.0, {0.0, 1.0}, "rad/s")};
}

DriverPlan ReadDriver(const TomlTable& table) {
  const auto time = [&table](const char* key) -> std::optional<double> {
    if (!table.Has(key)) return std::nullopt;
    return table.Number(key, kScenarioTime, "s");
  };
  return {.engage_at = time("engage_at").value_or(0.0),
          .disengage_at = time("disengage_at"),
          .brake_at = time("brake_at"),
          .steering_override_at = time("steering_override_at")};
}

Expectations ReadExpectations(const TomlTable& table) {
  const auto number = [&table](const char* key) -> std::optional<double> {
    if (!table.Has(key)) return std::nullopt;
    return table.Number(key, {-1e3, 1e3}, "m");
  };
  const auto limit = [&table](const char* key, const char* unit) -> std::optional<double> {
    if (!table.Has(key)) return std::nullopt;
    return table.Number(key, {0.0, 1e3}, unit);
  };
  const auto count = [&table](const char* key) -> std::optional<int> {
    if (!table.Has(key)) return std::nullopt;
    return table.Integer(key, {0, 1'000'000});
  };
  return {.completed = table.BooleanOr("completed", true),
          .max_infeasible_steps = count("max_infeasible_steps"),
          .min_clearance_m = number("min_clearance_m"),
          .min_road_margin_m = number("min_road_margin_m"),
          .max_rms_lateral_error_m = number("max_rms_lateral_error_m"),
          .max_deadline_misses = count("max_deadline_misses"),
          .max_speed_excess_mps = limit("max_speed_excess_mps", "m/s"),
          .max_rms_steering_rate = limit("max_rms_steering_rate", "rad/s"),
          .max_p99_steering_rate = limit("max_p99_steering_rate", "rad/s"),
          .max_rms_jerk = limit("max_rms_jerk", "m/s^3"),
          .max_p99_jerk = limit("max_p99_jerk", "m/s^3"),
          .max_free_standstill_s = limit("max_free_standstill_s", "s"),
          .max_end_overshoot_m = limit("max_end_overshoot_m", "m"),
          .max_end_gap_m = limit("max_end_gap_m", "m"),
          .max_mode_changes = count("max_mode_changes"),
          .max_safe_stops = count("max_safe_stops"),
          .min_time_to_collision_s = limit("min_time_to_collision_s", "s")};
}

void ReadInitial(const TomlTable& table, Scenario& scenario) {
  const double along = table.NumberOr("along", 0.0, {0.0, scenario.route.length()}, "m");
  const double lateral = table.NumberOr("lateral", 0.0, kObstacleLateral, "m");
  const double heading = table.NumberOr("heading", 0.0, {-1.0, 1.0}, "rad");
  const double speed = table.NumberOr("speed", scenario.route.At(along).speed, {0.0, 60.0}, "m/s");
  scenario.PlaceVehicle(along, speed, lateral, heading);
}

}  // namespace

// Uses linear single-track theory, which holds for the vehicle's own tyres at small slip.
void Scenario::PlaceVehicle(double along, double speed, double lateral, double heading) {
  const control::RoutePoint point = route.At(along);
  const control::VehicleParameters& v = plant.vehicle;
  const double wheelbase = v.l_f + v.l_r;
  const double rear_slip = v.m * v.l_f * speed * speed * point.curvature / (2.0 * v.C_alpha_r * wheelbase);
  const double front_slip = v.m * v.l_r * speed * speed * point.curvature / (2.0 * v.C_alpha_f * wheelbase);
  const double sideslip = v.l_r * point.curvature - rear_slip;

  const Eigen::Vector2d place = control::Beside(point, lateral);
  initial[control::kX] = place.x();
  initial[control::kY] = place.y();
  initial[control::kUpsilon] = speed;
  initial[control::kNu] = speed * sideslip;
  initial[control::kPsi] = control::WrapAngle(point.psi - sideslip + heading);
  initial[control::kOmega] = speed * point.curvature;
  initial_delta = wheelbase * point.curvature + front_slip - rear_slip;
}

Scenario LoadScenario(const std::filesystem::path& file) {
  const TomlTable table = TomlTable::Read(file);
  const config::RouteFile route = config::LoadRoute(table.Path("route"));
  Scenario scenario(route.route, route.road);
  scenario.name = table.Text("name");
  scenario.description = table.TextOr("description", "");
  scenario.seed = static_cast<std::uint64_t>(table.IntegerOr("seed", 1, {.min = 0}));
  if (table.Has("duration")) scenario.duration = table.Number("duration", {0.1, 1e5}, "s");
  if (table.Has("daemon_config")) scenario.daemon_config = table.Path("daemon_config");
  ReadVehicle(table.Table("vehicle"), scenario);
  ReadInitial(table.Table("initial"), scenario);
  ReadObstacles(table, scenario);
  scenario.sensors = ReadSensors(table.Table("sensors"));
  scenario.driver = ReadDriver(table.Table("driver"));
  scenario.expect = ReadExpectations(table.Table("expect"));
  table.RefuseUnknownKeys();
  return scenario;
}

}  // namespace sim
