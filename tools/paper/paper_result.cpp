#include "tools/paper/paper_result.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tools {
namespace {

constexpr int kMostStandard = 3;  // scenarios in which the standard LPVMPC may be feasible

int CountFeasible(const std::vector<FeasibilityRow>& rows, FeasibilityDrive FeasibilityRow::*drive) {
  return static_cast<int>(
      std::ranges::count_if(rows, [&](const auto& row) { return (row.*drive).feasible(); }));
}

bool Clear(const ComparedDrive& drive) {
  return drive.figures.summary.min_clearance_m.value_or(-1.0) >= 0.0;
}

// "NAME: yes", or the scenario's expectations that the drive did not meet.
std::string Shortcomings(const char* name, const ComparedDrive& drive) {
  const auto& failed = drive.figures.summary.failed_expectations;
  return fmt::format("{}: {}", name, failed.empty() ? "yes" : fmt::format("{}", fmt::join(failed, ", ")));
}

}  // namespace

std::vector<Claim> JudgeClaims(const PaperResult& result) {
  std::vector<Claim> claims;
  const int trust_region = CountFeasible(result.feasibility, &FeasibilityRow::trust_region);
  const int standard = CountFeasible(result.feasibility, &FeasibilityRow::standard);
  claims.push_back({.text = fmt::format("LPVMPC with trust region feasible in {0} of {0} scenarios",
                                        kFeasibilityScenarios),
                    .seen = fmt::format("{}", trust_region),
                    .holds = trust_region == kFeasibilityScenarios});
  claims.push_back({.text = fmt::format("standard LPVMPC feasible in at most {}", kMostStandard),
                    .seen = fmt::format("{}", standard),
                    .holds = standard <= kMostStandard});
  for (const ComparisonRow& row : result.comparison) {
    claims.push_back(
        {.text = fmt::format("{}: LPVMPC at least {:.0f} times faster than NMPC", row.name, kLeastSpeedup),
         .seen = fmt::format("{:.0f} times", row.speedup()),
         .holds = row.speedup() >= kLeastSpeedup});
    claims.push_back({.text = fmt::format("{}: both drive as expected, every step solved", row.name),
                      .seen = Shortcomings("NMPC", row.nmpc) + "; " + Shortcomings("LPVMPC", row.lpv),
                      .holds = row.nmpc.figures.summary.passed() && row.lpv.figures.summary.passed()});
    if (!row.has_obstacle) continue;
    claims.push_back({.text = fmt::format("{}: both pass the obstacle without contact", row.name),
                      .seen = fmt::format("{:.3f} m (NMPC), {:.3f} m (LPVMPC)",
                                          row.nmpc.figures.summary.min_clearance_m.value_or(-1.0),
                                          row.lpv.figures.summary.min_clearance_m.value_or(-1.0)),
                      .holds = Clear(row.nmpc) && Clear(row.lpv)});
  }
  return claims;
}

const ComparisonRow& LargestCostGap(const PaperResult& result) {
  return *std::ranges::max_element(result.comparison, {}, &ComparisonRow::cost_gap);
}

const char* NameOf(CircleOutcome outcome) {
  switch (outcome) {
    case CircleOutcome::kClear:
      return "clear";
    case CircleOutcome::kMarginal:
      return "marginal";
    case CircleOutcome::kTouch:
      return "touch";
    case CircleOutcome::kOffRoad:
      return "off-road";
    case CircleOutcome::kInfeasible:
      break;
  }
  return "infeasible";
}

std::string OutcomeText(const FeasibilityDrive& drive) {
  if (drive.figures.first_failure) return ToText(*drive.figures.first_failure);
  return drive.feasible() ? "feasible" : "not completed";
}

std::string ClearanceText(const DriveFigures& figures) {
  const auto& clearance = figures.summary.min_clearance_m;
  return clearance ? fmt::format("{:.3f} m", *clearance) : "-";
}

std::string PercentText(double share) {
  const double percent = std::round(1000.0 * share) / 10.0;
  return fmt::format("{:+.1f} %", percent == 0.0 ? 0.0 : percent);  // avoids "-0.0"
}

}  // namespace tools
