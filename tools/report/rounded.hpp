// Numbers of a report page's data, with no more digits than a plot shows.
#pragma once

#include <cmath>

namespace tools {

[[nodiscard]] inline double Rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

}  // namespace tools
