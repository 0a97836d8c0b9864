// What the scenarios of a sweep are drawn from.
#pragma once

namespace tools {

struct Interval {
  double low = 0.0;
  double high = 0.0;
  bool operator==(const Interval&) const = default;
};

struct ScenarioRanges {
  Interval speed{8.0, 20.0};  // target speed [m/s]
  Interval mu{0.4, 1.0};      // friction coefficient of the road [1]
  bool traffic = false;       // with traffic (traffic_scenario.hpp), instead of one to three obstacles
  bool operator==(const ScenarioRanges&) const = default;
};

inline constexpr Interval kSpeedLimits{3.0, 40.0};
inline constexpr Interval kMuLimits{0.1, 1.2};

// Throws std::invalid_argument, naming the command-line option, if a range exceeds these limits, is reversed or NaN.
void CheckRanges(const ScenarioRanges& ranges);

}  // namespace tools
