// The points of the unit cube of which each is one scenario with traffic (traffic_scenario.hpp), and their keys.
//
// A key is text of two digits for each coordinate, in base 64 with the digits A to Z, a to z, 0 to 9, '.' and '_': n is the
// middle of the n-th of 4096 equal parts of [0, 1), counted from 0. So it names exactly the points on this grid.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace tools {

// Coordinates of each kind of thing that is drawn, in this order.
inline constexpr std::size_t kRoadCoordinates = 30, kVehicleCoordinates = 16, kFollowerCoordinates = 7,
                             kLeaderCoordinates = 13, kOncomingCoordinates = 8, kCrossingCoordinates = 9,
                             kGroupCoordinates = 9, kBesideCoordinates = 7, kParkedCoordinates = 9;
inline constexpr std::size_t kOncoming = 2, kCrossing = 2, kParked = 2;  // things of a kind, at most
inline constexpr std::size_t kTrafficDimensions =
    kVehicleCoordinates + kRoadCoordinates + kFollowerCoordinates + kLeaderCoordinates +
    kOncoming * kOncomingCoordinates + kCrossing * kCrossingCoordinates + kGroupCoordinates +
    kBesideCoordinates + kParked * kParkedCoordinates;

using TrafficPoint = std::array<double, kTrafficDimensions>;

// Uniformly distributed points; each seed has its own.
[[nodiscard]] TrafficPoint PointOf(std::uint64_t seed);

[[nodiscard]] TrafficPoint OnGrid(const TrafficPoint& point);  // the nearest point that has a key
[[nodiscard]] std::string KeyOf(const TrafficPoint& point);    // of OnGrid(point)
// Throws std::invalid_argument, naming the command-line option, if `key` is none.
[[nodiscard]] TrafficPoint PointOf(std::string_view key);

}  // namespace tools
