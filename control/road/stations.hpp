// The places along the road at which manoeuvres are planned: kStations points at equal distances from the vehicle on.
#pragma once

#include <array>
#include <cstddef>

namespace control {

inline constexpr std::size_t kStations = 36;
using StationValues = std::array<double, kStations>;

// Arc length of station j: s_0 + j spacing.
struct Stations {
  double s_0 = 0.0;      // of the vehicle [m]
  double spacing = 1.0;  // > 0 [m]

  [[nodiscard]] double At(std::size_t j) const { return s_0 + static_cast<double>(j) * spacing; }
  [[nodiscard]] double length() const { return static_cast<double>(kStations - 1) * spacing; }
};

}  // namespace control
