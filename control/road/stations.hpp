// The places along the road at which manoeuvres are planned: the vehicle's own and kStations − 1 points ahead at equal
// distances. The points are fixed to the road, and not to the vehicle: otherwise the edges of what stands beside the road
// would fall to one station or the next by turns, and the plan would change from cycle to cycle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace control {

inline constexpr std::size_t kStations = 36;
using StationValues = std::array<double, kStations>;

struct Stations {
  struct Place {
    std::size_t j = 0;      // of the station before it
    double fraction = 0.0;  // of the way to the next one, 0..1
  };

  double s_0 = 0.0;      // arc length of the vehicle [m]
  double spacing = 1.0;  // of the points ahead, > 0 [m]
  double shift = 0.0;    // by which the way to the first of them is longer, > −spacing [m]

  // Points at multiples of `spacing`, the first at half of it or more from the vehicle.
  [[nodiscard]] static Stations OnGrid(double s_0, double spacing) {
    const double first = std::ceil(s_0 / spacing + 0.5) * spacing;
    return {.s_0 = s_0, .spacing = spacing, .shift = first - s_0 - spacing};
  }

  // Arc length of station j [m].
  [[nodiscard]] double At(std::size_t j) const {
    return j == 0 ? s_0 : s_0 + shift + static_cast<double>(j) * spacing;
  }
  // The way from station j to the next one [m].
  [[nodiscard]] double Step(std::size_t j) const { return j == 0 ? spacing + shift : spacing; }
  [[nodiscard]] double length() const { return At(kStations - 1) - s_0; }
  // Places before the first and behind the last station are taken to be there.
  [[nodiscard]] Place PlaceOf(double s) const {
    const double place = (s - s_0 - shift) / spacing;
    if (place < 1.0) return {.fraction = std::max((s - s_0) / Step(0), 0.0)};
    if (place >= static_cast<double>(kStations - 1)) return {.j = kStations - 1};
    const auto j = static_cast<std::size_t>(place);
    return {.j = j, .fraction = place - static_cast<double>(j)};
  }
};

}  // namespace control
