#include "config/route_file.hpp"

#include <Eigen/Core>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "config/toml_table.hpp"
#include "config/waypoint_file.hpp"

namespace config {
namespace {

constexpr Range<double> kPosition{-1e6, 1e6};   // [m]
constexpr Range<double> kHeading{-6.3, 6.3};    // [rad]
constexpr Range<double> kSpeed{0.1, 100.0};     // [m/s]
constexpr Range<double> kLength{0.01, 1e5};     // [m]
constexpr Range<double> kCurvature{-0.5, 0.5};  // [1/m]
constexpr Range<double> kRadius{2.0, 1e6};      // [m]
constexpr Range<double> kWidth{0.1, 100.0};     // [m]
constexpr double kLongestRoute = 1e6;           // [m]
constexpr double kLongestDrive = 1e5;           // [s]

double ArcCurvature(const TomlTable& table) {
  if (!table.Has("radius")) return table.Number("curvature", kCurvature, "1/m");
  if (table.Has("curvature")) throw table.Error("curvature", "must not be given along with radius");
  const double radius = table.Number("radius", kRadius, "m");
  return (table.Choice("turn", {"left", "right"}) == 0 ? 1.0 : -1.0) / radius;
}

control::RoutePiece ReadPiece(const TomlTable& table) {
  control::RoutePiece piece;
  const std::size_t kind = table.Choice("kind", {"straight", "arc", "clothoid"});
  piece.length = table.Number("length", kLength, "m");
  if (kind == 1) piece.curvature_from = piece.curvature_to = ArcCurvature(table);
  if (kind == 2) {
    piece.curvature_from = table.Number("curvature_from", kCurvature, "1/m");
    piece.curvature_to = table.Number("curvature_to", kCurvature, "1/m");
  }
  if (table.Has("speed")) piece.speed = table.Number("speed", kSpeed, "m/s");
  return piece;
}

// Returns the route that `make` builds from the value of `key`. A route is kept in memory as points one cycle
// apart, hence the limits.
template <typename Make>
control::Route Checked(const TomlTable& table, std::string_view key, double length, const Make& make) {
  if (length > kLongestRoute) {
    throw table.Error(key, fmt::format("is {} m long, must be at most {} m", length, kLongestRoute));
  }
  try {
    control::Route route = make();
    if (route.duration() <= kLongestDrive) return route;
    throw table.Error(key, fmt::format("takes {:.0f} s at its speed, must be at most {} s", route.duration(),
                                       kLongestDrive));
  } catch (const std::invalid_argument& error) {
    throw table.Error(key, fmt::format("gives no route: {}", error.what()));
  }
}

control::Route ReadPieces(const TomlTable& table, double speed) {
  const TomlTable start_table = table.Table("start");
  const control::RouteStart start{.X = start_table.Number("X", kPosition, "m"),
                                  .Y = start_table.Number("Y", kPosition, "m"),
                                  .psi = start_table.Number("psi", kHeading, "rad")};
  std::vector<control::RoutePiece> pieces;
  for (const TomlTable& piece : table.Tables("pieces")) pieces.push_back(ReadPiece(piece));
  if (pieces.empty()) throw table.Error("pieces", "must hold at least one piece, or waypoints must be given");
  double length = 0.0;
  for (const control::RoutePiece& piece : pieces) length += piece.length;
  return Checked(table, "pieces", length, [&] { return control::Route::FromPieces(start, speed, pieces); });
}

control::Route ReadWaypoints(const TomlTable& table, double speed) {
  const std::vector<Eigen::Vector2d> waypoints = LoadWaypoints(table.Path("waypoints"));
  double length = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) length += (waypoints[i] - waypoints[i - 1]).norm();
  return Checked(table, "waypoints", length,
                 [&] { return control::Route::ThroughWaypoints(waypoints, speed); });
}

control::Route ReadRoute(const TomlTable& table) {
  const double speed = table.Number("speed", kSpeed, "m/s");
  if (!table.Has("waypoints")) return ReadPieces(table, speed);
  for (const char* key : {"start", "pieces"}) {
    if (table.Has(key)) throw table.Error(key, "must not be given along with waypoints");
  }
  return ReadWaypoints(table, speed);
}

}  // namespace

RouteFile LoadRoute(const std::filesystem::path& file) {
  const TomlTable table = TomlTable::Read(file);
  const TomlTable road = table.Table("road");
  RouteFile result{
      .route = ReadRoute(table.Table("route")),
      .road = {.left = road.Number("left", kWidth, "m"), .right = -road.Number("right", kWidth, "m")},
  };
  table.RefuseUnknownKeys();
  return result;
}

}  // namespace config
