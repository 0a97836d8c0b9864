#include "config/route_file.hpp"

#include <Eigen/Core>
#include <fmt/format.h>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "config/route_limits.hpp"
#include "config/toml_table.hpp"
#include "config/waypoint_file.hpp"

namespace config {
namespace {

constexpr Range<double> kHeading{-6.3, 6.3};    // [rad]
constexpr Range<double> kLength{0.01, 1e5};     // [m]
constexpr Range<double> kCurvature{-0.5, 0.5};  // [1/m]
constexpr Range<double> kRadius{2.0, 1e6};      // [m]
constexpr double kLongestRoute = 1e6;           // [m]
constexpr double kLongestDrive = 1e5;           // [s]

double ArcCurvature(const TomlTable& table) {
  if (!table.Has("radius")) return table.Number("curvature", kCurvature, "1/m");
  if (table.Has("curvature")) throw table.Error("curvature", "must not be given along with radius");
  const double radius = table.Number("radius", kRadius, "m");
  return (table.Choice("turn", {"left", "right"}) == 0 ? 1.0 : -1.0) / radius;
}

// A piece of the route, and the road's edges at its end.
struct Piece {
  control::RoutePiece course;
  control::RoadBounds road;
};

// `road`: the edges at the piece's start, which are those at its end unless it gives others.
Piece ReadPiece(const TomlTable& table, control::RoadBounds road) {
  control::RoutePiece piece;
  const std::size_t kind = table.Choice("kind", {"straight", "arc", "clothoid"});
  piece.length = table.Number("length", kLength, "m");
  if (kind == 1) piece.curvature_from = piece.curvature_to = ArcCurvature(table);
  if (kind == 2) {
    piece.curvature_from = table.Number("curvature_from", kCurvature, "1/m");
    piece.curvature_to = table.Number("curvature_to", kCurvature, "1/m");
  }
  if (table.Has("speed")) piece.speed = table.Number("speed", kSpeedRange, "m/s");
  if (table.Has("left")) road.left = table.Number("left", kWidthRange, "m");
  if (table.Has("right")) road.right = -table.Number("right", kWidthRange, "m");
  return {.course = piece, .road = road};
}

control::RoadBounds ReadRoad(const TomlTable& table) {
  return {.left = table.Number("left", kWidthRange, "m"), .right = -table.Number("right", kWidthRange, "m")};
}

// The edges of a road with these bounds at the route's knots.
control::RoadEdges EdgesOf(const control::Route& route, std::span<const control::RoadBounds> bounds) {
  std::vector<control::RoadSample> samples;
  for (std::size_t k = 0; k < bounds.size(); ++k)
    samples.push_back({.s = route.knots()[k], .bounds = bounds[k]});
  return control::RoadEdges(samples);
}

// Returns the route and road that `make` builds from the value of `key`. A route is kept in memory as points one cycle
// apart, hence the limits.
template <typename Make>
RouteFile Checked(const TomlTable& table, std::string_view key, double length, const Make& make) {
  if (length > kLongestRoute) {
    throw table.Error(key, fmt::format("is {} m long, must be at most {} m", length, kLongestRoute));
  }
  try {
    RouteFile file = make();
    if (file.route.duration() <= kLongestDrive) return file;
    throw table.Error(key, fmt::format("takes {:.0f} s at its speed, must be at most {} s",
                                       file.route.duration(), kLongestDrive));
  } catch (const std::invalid_argument& error) {
    throw table.Error(key, fmt::format("gives no route: {}", error.what()));
  }
}

RouteFile ReadPieces(const TomlTable& table, const control::RoadBounds& road) {
  const double speed = table.Number("speed", kSpeedRange, "m/s");
  const TomlTable start_table = table.Table("start");
  const control::RouteStart start{.X = start_table.Number("X", kPositionRange, "m"),
                                  .Y = start_table.Number("Y", kPositionRange, "m"),
                                  .psi = start_table.Number("psi", kHeading, "rad")};
  std::vector<control::RoutePiece> pieces;
  std::vector<control::RoadBounds> bounds{road};
  double length = 0.0;
  for (const TomlTable& piece_table : table.Tables("pieces")) {
    const Piece piece = ReadPiece(piece_table, bounds.back());
    pieces.push_back(piece.course);
    bounds.push_back(piece.road);
    length += piece.course.length;
  }
  if (pieces.empty()) throw table.Error("pieces", "must hold at least one piece, or waypoints must be given");
  return Checked(table, "pieces", length, [&] {
    const control::Route route = control::Route::FromPieces(start, speed, pieces);
    return RouteFile{.route = route, .road = EdgesOf(route, bounds)};
  });
}

control::Route RouteThrough(const Waypoints& waypoints, const TomlTable& table) {
  if (waypoints.speeds.empty())
    return control::Route::ThroughWaypoints(waypoints.points, table.Number("speed", kSpeedRange, "m/s"));
  if (table.Has("speed"))
    throw table.Error("speed", "must not be given along with waypoints that have speeds");
  return control::Route::ThroughWaypoints(waypoints.points, waypoints.speeds);
}

control::RoadEdges EdgesAlong(const control::Route& route, const Waypoints& waypoints,
                              const TomlTable& file) {
  if (waypoints.road.empty()) return ReadRoad(file.Table("road"));
  if (file.Has("road")) throw file.Error("road", "must not be given along with waypoints that have widths");
  return EdgesOf(route, waypoints.road);
}

RouteFile ReadWaypoints(const TomlTable& table, const TomlTable& file) {
  for (const char* key : {"start", "pieces"}) {
    if (table.Has(key)) throw table.Error(key, "must not be given along with waypoints");
  }
  const Waypoints waypoints = LoadWaypoints(table.Path("waypoints"));
  const std::vector<Eigen::Vector2d>& points = waypoints.points;
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return Checked(table, "waypoints", length, [&] {
    const control::Route route = RouteThrough(waypoints, table);
    return RouteFile{.route = route, .road = EdgesAlong(route, waypoints, file)};
  });
}

}  // namespace

RouteFile LoadRoute(const std::filesystem::path& file) {
  const TomlTable table = TomlTable::Read(file);
  const TomlTable route = table.Table("route");
  RouteFile result =
      route.Has("waypoints") ? ReadWaypoints(route, table) : ReadPieces(route, ReadRoad(table.Table("road")));
  table.RefuseUnknownKeys();
  return result;
}

}  // namespace config
