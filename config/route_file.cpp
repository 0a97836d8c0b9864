#include "config/route_file.hpp"

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

control::Route ReadPieces(const TomlTable& table, double speed) {
  const TomlTable start_table = table.Table("start");
  const control::RouteStart start{.X = start_table.Number("X", kPosition, "m"),
                                  .Y = start_table.Number("Y", kPosition, "m"),
                                  .psi = start_table.Number("psi", kHeading, "rad")};
  std::vector<control::RoutePiece> pieces;
  for (const TomlTable& piece : table.Tables("pieces")) pieces.push_back(ReadPiece(piece));
  if (pieces.empty()) throw table.Error("pieces", "must hold at least one piece, or waypoints be given");
  return control::Route::FromPieces(start, speed, pieces);
}

control::Route ReadRoute(const TomlTable& table) {
  const double speed = table.Number("speed", kSpeed, "m/s");
  if (!table.Has("waypoints")) return ReadPieces(table, speed);
  for (const char* key : {"start", "pieces"}) {
    if (table.Has(key)) throw table.Error(key, "must not be given along with waypoints");
  }
  return control::Route::ThroughWaypoints(LoadWaypoints(table.Path("waypoints")), speed);
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
