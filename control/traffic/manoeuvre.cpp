#include "control/traffic/manoeuvre.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {

double Manoeuvre::SpeedLimitAt(double s) const {
  const double place = (s - path.stations.s_0) / path.stations.spacing;
  if (!path.exists || place >= static_cast<double>(kStations - 1))
    return std::numeric_limits<double>::infinity();
  if (place <= 0.0) return speed_limit[0];
  const auto j = static_cast<std::size_t>(place);
  const double fraction = place - static_cast<double>(j);
  const double from = speed_limit[j], to = speed_limit[j + 1];
  return std::sqrt(from * from + fraction * (to * to - from * from));
}

double Manoeuvre::LeastAround(const StationValues& values, double s) const {
  const double place =
      std::clamp((s - path.stations.s_0) / path.stations.spacing, 0.0, static_cast<double>(kStations - 1));
  const auto j = static_cast<std::size_t>(place);
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
