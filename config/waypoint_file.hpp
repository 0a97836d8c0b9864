// Reads the waypoints of a route from a CSV file: a header line, then one line of numbers per waypoint. The header is one of
//
//   X,Y            X,Y,speed
//   X,Y,left,right X,Y,left,right,speed
//
// with positions and the distances from the waypoint to the road's edges in metres, both distances positive, and the
// target speed at the waypoint in m/s, or it is that of the race-track format of TUM
// (https://github.com/TUMFTM/racetrack-database):
//
//   # x_m,y_m,w_tr_right_m,w_tr_left_m
//
// A race track's first point is not repeated at its end. Such a line is closed, by its first point again, if it has at least
// five points and the gap is at most three times their median spacing. Blank lines and other lines that begin with # are
// skipped.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "config/toml_table.hpp"
#include "control/vehicle/types.hpp"

namespace config {

struct Waypoints {
  std::vector<Eigen::Vector2d> points;
  std::vector<control::RoadBounds> road;  // one for each point; empty if the file has no widths
  std::vector<double> speeds;             // one for each point [m/s]; empty if the file has none
};

// Throws ConfigError, such as "FILE:LINE: column 'Y' = "..." ...", if the file cannot be read, the header or the number of
// columns differs, a value is not a number or outside its range (positions ±1000 km, widths 0.1 to 100 m, speeds 0.1 to
// 100 m/s), a waypoint repeats its predecessor, or there are fewer than two.
[[nodiscard]] Waypoints LoadWaypoints(const std::filesystem::path& file);

}  // namespace config
