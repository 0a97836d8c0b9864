#include "control/traffic/manoeuvre.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {

double Manoeuvre::SpeedLimitAt(double s) const {
  const auto [j, fraction] = path.stations.PlaceOf(s);
  if (!path.exists || j == kStations - 1) return std::numeric_limits<double>::infinity();
  const double from = speed_limit[j], to = speed_limit[j + 1];
  return std::sqrt(from * from + fraction * (to * to - from * from));
}

double Manoeuvre::LeastAround(const StationValues& values, double s) const {
  const std::size_t j = path.stations.PlaceOf(s).j;
  return std::min(values[j], values[std::min(j + 1, kStations - 1)]);
}

double Manoeuvre::Yielding(double s, double usual) const {
  constexpr double kPlay = 0.3;  // wanted between the margins [m]
  if (!path.exists) return usual;
  return std::max(usual - 0.5 * std::max(kPlay - LeastAround(play, s), 0.0), 0.5 * usual);
}

double Manoeuvre::RoadMarginAt(double s, double usual) const {
  return path.exists ? Yielding(s, LeastAround(share, s) * usual) : usual;
}

}  // namespace control
