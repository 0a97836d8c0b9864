// A drive of one point of the search, and how near it came to a fault of the vehicle's.
#pragma once

#include <optional>
#include <string>

#include "sim/summary.hpp"
#include "tools/falsify/falsify_setup.hpp"
#include "tools/scenarios/possible_way.hpp"
#include "tools/scenarios/traffic_point.hpp"
#include "tools/sweep/sweep_outcome.hpp"

namespace tools {

// The smaller of the least clearance and the least distance of a corner from the road's edge [m], negative if one was
// violated. A clearance that became negative by the other's fault alone does not count. None if nothing was measured.
[[nodiscard]] std::optional<double> MarginOf(const sim::Summary& summary);

// The margin of the point's drive; none too if it is negative although there was no way (space_time_way.hpp).
[[nodiscard]] std::optional<double> DriveMargin(const TrafficPoint& point, const FalsifySetup& setup);

// What is told of a point.
struct Finding {
  std::string key;  // of the point (traffic_point.hpp)
  double margin = 0.0;
  SweepOutcome outcome = SweepOutcome::kPassed;
  std::string why;  // empty if the outcome is no failure
  PossibleWay way = PossibleWay::kPass;
  std::string description;  // of the scenario
};

// Drives the point again.
[[nodiscard]] Finding FindingOf(const TrafficPoint& point, double margin, const FalsifySetup& setup);

}  // namespace tools
