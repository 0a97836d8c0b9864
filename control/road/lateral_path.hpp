// A path beside the road's reference path: its lateral offset d(s), left positive, with continuous slope d'(s) = dd/ds and
// a bend d''(s) that is constant between stations.
#pragma once

#include <cstddef>

#include "control/road/stations.hpp"

namespace control {

struct LateralPoint {
  double offset = 0.0;  // d [m]
  double slope = 0.0;   // d'
  double bend = 0.0;    // d'' [1/m]
};

struct LateralPath {
  Stations stations;
  StationValues offset{};
  StationValues slope{};
  StationValues bend{};
  bool exists = false;  // false: d = 0 throughout

  // Constant beyond the last station.
  [[nodiscard]] LateralPoint At(double s) const {
    if (!exists) return {};
    const std::size_t j = stations.PlaceOf(s).j;
    if (j == kStations - 1) return {.offset = offset[j]};
    const double ds = s - stations.At(j);
    return {.offset = offset[j] + ds * (slope[j] + 0.5 * ds * bend[j]),
            .slope = slope[j] + ds * bend[j],
            .bend = bend[j]};
  }
};

}  // namespace control
