#include "sim/motion_table.hpp"

#include <array>
#include <string_view>

namespace sim {
namespace {

using config::TomlTable;

const std::array<std::string_view, 4> kAlongRoute{"speed", "speed_profile", "lateral_profile", "follows"};

void RefuseAlong(const TomlTable& table, std::string_view key, std::string_view with) {
  if (!table.Has(key)) return;
  throw table.Error(key, "must not be given along with " + std::string(with));
}

// The time of a profile's point, which must be later than that of the point before.
double ReadTime(const TomlTable& point, std::optional<double> before) {
  const double time = point.Number("time", kScenarioTime, "s");
  if (before && time <= *before) throw point.Error("time", "must be later than that of the point before");
  return time;
}

template <typename Point, typename Read>
std::vector<Point> ReadProfile(const TomlTable& table, std::string_view key, const Read& read) {
  std::vector<Point> points;
  for (const TomlTable& element : table.Tables(key)) {
    const double time =
        ReadTime(element, points.empty() ? std::nullopt : std::optional<double>(points.back().time));
    points.push_back({time, read(element)});
  }
  if (points.empty()) throw table.Error(key, "must have at least one point");
  return points;
}

std::vector<SpeedPoint> ReadSpeed(const TomlTable& table) {
  if (!table.Has("speed_profile")) return {{.speed = table.NumberOr("speed", 0.0, kObstacleSpeed, "m/s")}};
  RefuseAlong(table, "speed", "speed_profile");
  return ReadProfile<SpeedPoint>(table, "speed_profile", [](const TomlTable& point) {
    return point.Number("speed", kObstacleSpeed, "m/s");
  });
}

std::vector<LateralPoint> ReadLateral(const TomlTable& table) {
  if (!table.Has("lateral_profile"))
    return {{.lateral = table.NumberOr("lateral", 0.0, kObstacleLateral, "m")}};
  RefuseAlong(table, "lateral", "lateral_profile");
  return ReadProfile<LateralPoint>(table, "lateral_profile", [](const TomlTable& point) {
    return point.Number("lateral", kObstacleLateral, "m");
  });
}

bool ReadFollows(const TomlTable& table) {
  if (!table.BooleanOr("follows", false)) return false;
  RefuseAlong(table, "speed_profile", "follows");
  if (table.Number("speed", kObstacleSpeed, "m/s") == 0.0)
    throw table.Error("speed", "must not be 0 along with follows");
  return true;
}

}  // namespace

std::optional<RouteMotion> ReadRouteMotion(const TomlTable& table, const control::Route& route) {
  if (!table.BooleanOr("along_route", false)) {
    for (const std::string_view key : kAlongRoute) {
      if (table.Has(key)) throw table.Error(key, "must not be given without along_route = true");
    }
    return std::nullopt;
  }
  if (!table.Has("s")) throw table.Error("along_route", "must not be true without s");
  RefuseAlong(table, "velocity_X", "along_route");
  RefuseAlong(table, "velocity_Y", "along_route");
  RouteMotion motion;
  motion.follows = ReadFollows(table);
  motion.s = table.Number("s", {0.0, route.length()}, "m");
  motion.heading = table.NumberOr("heading", 0.0, kObstacleHeading, "rad");
  motion.speed = ReadSpeed(table);
  motion.lateral = ReadLateral(table);
  return motion;
}

}  // namespace sim
