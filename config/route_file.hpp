// A route file in TOML: the reference path with its target speed, and the edges of the road.
//
//   [route]
//   start = {X = 0.0, Y = 0.0, psi = 0.0}    # [m], [m], [rad]
//   speed = 12.0                             # target speed at the start [m/s]
//   pieces = [                               # lengths [m]; curvatures [1/m] and turns are positive to the left
//     {kind = "straight", length = 100.0},
//     {kind = "clothoid", length = 40.0, curvature_from = 0.0, curvature_to = 0.0125},
//     {kind = "arc", length = 60.0, curvature = 0.0125},
//     {kind = "arc", length = 60.0, radius = 80.0, turn = "left"},    # the same
//     {kind = "straight", length = 25.0, speed = 8.0},                # any piece: target speed at its end
//     {kind = "straight", length = 25.0, left = 2.0, right = 3.0},    # any piece: distances to the edges at its end
//   ]
//   # instead of start and pieces: a CSV file (waypoint_file.hpp), whose points a natural cubic spline joins
//   # waypoints = "points.csv"
//   [road]                                   # distances from the path to the road's edges, both positive [m];
//   left = 4.0                               # of pieces, those at the start
//   right = 4.0
//
// Speed and distances to the edges change linearly along a piece; a piece that does not give one keeps it. Waypoints can
// have distances to the edges, and then [road] must be absent, or speeds of their own, and then so must be `speed`. A race
// track in the format of TUM is such a CSV file.
//
// A route is at most 1000 km long and takes at most 100,000 s at its target speed. Paths are relative to this file.
#pragma once

#include <filesystem>

#include "control/road/road_edges.hpp"
#include "control/road/route.hpp"

namespace config {

struct RouteFile {
  control::Route route;
  control::RoadEdges road;
};

// Throws ConfigError, which names file, line, key, value and what is allowed.
[[nodiscard]] RouteFile LoadRoute(const std::filesystem::path& file);

}  // namespace config
