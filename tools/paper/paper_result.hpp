// Everything that `lpvmpc paper` found out, and whether the paper's claims hold in it.
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
  double seconds = 0.0;  // that all of it took
};

inline constexpr double kLeastSpeedup = 20.0;  // of the LPVMPC over the NMPC, by the average, that is claimed

struct Claim {
  std::string text;
  std::string seen;
  bool holds = false;
};

[[nodiscard]] std::vector<Claim> JudgeClaims(const PaperResult& result);

// The comparison whose LPVMPC is dearest against its NMPC.
[[nodiscard]] const ComparisonRow& LargestCostGap(const PaperResult& result);

// For a terminal.
[[nodiscard]] std::string ToText(const PaperResult& result);
// {"claims", "feasibility", "comparison", "largest_cost_gap", "map" or null, "seconds", "passed"}; times in s.
[[nodiscard]] nlohmann::ordered_json ToJson(const PaperResult& result);
// The data of its page (report_page.hpp).
[[nodiscard]] nlohmann::ordered_json PaperPage(const PaperResult& result);

// Words for the outcomes of the map, as in the page's data.
[[nodiscard]] const char* NameOf(CircleOutcome outcome);
// The panel's cells by these words: for each shift, for each speed.
[[nodiscard]] nlohmann::ordered_json CellData(const MapPanel& panel);
// "feasible", "not completed", or which step was not solved and why.
[[nodiscard]] std::string OutcomeText(const FeasibilityDrive& drive);
[[nodiscard]] std::string ClearanceText(const DriveFigures& figures);  // "0.062 m", "-" without an obstacle
[[nodiscard]] std::string PercentText(double share);                   // "+5.0 %" of 0.05

}  // namespace tools
