// The result of `lpvmpc paper`, and whether the paper's claims hold in it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/paper/comparison.hpp"
#include "tools/paper/feasibility.hpp"
#include "tools/paper/feasibility_map.hpp"

namespace tools {

struct PaperResult {
  std::vector<FeasibilityRow> feasibility;
  std::vector<ComparisonRow> comparison;
  std::optional<FeasibilityMap> map;
  double seconds = 0.0;  // total duration [s]
};

inline constexpr double kLeastSpeedup = 20.0;  // claimed average speedup of the LPVMPC over the NMPC

struct Claim {
  std::string text;
  std::string seen;
  bool holds = false;
};

[[nodiscard]] std::vector<Claim> JudgeClaims(const PaperResult& result);

// The comparison with the largest cost gap.
[[nodiscard]] const ComparisonRow& LargestCostGap(const PaperResult& result);

// Text for a terminal.
[[nodiscard]] std::string ToText(const PaperResult& result);
// {"claims", "feasibility", "comparison", "largest_cost_gap", "map" or null, "seconds", "passed"}; times in s.
[[nodiscard]] nlohmann::ordered_json ToJson(const PaperResult& result);
// The data of the result's page (report_page.hpp).
[[nodiscard]] nlohmann::ordered_json PaperPage(const PaperResult& result);

// The outcome's name in the page's data.
[[nodiscard]] const char* NameOf(CircleOutcome outcome);
// The names of the panel's outcomes, for each shift and each speed.
[[nodiscard]] nlohmann::ordered_json CellData(const MapPanel& panel);
// "feasible", "not completed", or the first unsolved step and the reason.
[[nodiscard]] std::string OutcomeText(const FeasibilityDrive& drive);
[[nodiscard]] std::string ClearanceText(const DriveFigures& figures);  // "0.062 m", "-" without an obstacle
[[nodiscard]] std::string PercentText(double share);                   // "+5.0 %" of 0.05

}  // namespace tools
