#include "tools/scenarios/scenario_ranges.hpp"

#include <fmt/format.h>
#include <stdexcept>

namespace tools {
namespace {

void Check(const char* option, const Interval& range, const Interval& limits) {
  // The condition is stated positively so that NaN is rejected too.
  if (limits.low <= range.low && range.low <= range.high && range.high <= limits.high) return;
  throw std::invalid_argument(fmt::format("{}: {} {} must be LO HI with {} <= LO <= HI <= {}", option,
                                          range.low, range.high, limits.low, limits.high));
}

}  // namespace

void CheckRanges(const ScenarioRanges& ranges) {
  Check("--speed", ranges.speed, kSpeedLimits);
  Check("--mu", ranges.mu, kMuLimits);
}

}  // namespace tools
