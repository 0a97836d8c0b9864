#include <fmt/format.h>
#include <string_view>

#include "tools/paper/paper_result.hpp"

namespace tools {
namespace {

void AppendFeasibility(const PaperResult& result, std::string& text) {
  text +=
      "Feasibility: ten obstacles on a circular road, standard LPVMPC against LPVMPC with trust region\n\n";
  for (const FeasibilityRow& row : result.feasibility) {
    text += fmt::format("  {}  {}\n", row.number, row.description);
    const auto line = [&](const char* name, const FeasibilityDrive& drive) {
      text += fmt::format("      {:13}{}; plans change by up to {:.2f} m from step to step", name,
                          OutcomeText(drive), drive.largest_plan_change);
      text += drive.feasible() ? fmt::format(", clearance {}\n", ClearanceText(drive.figures)) : "\n";
    };
    line("standard", row.standard);
    line("trust region", row.trust_region);
  }
}

void AppendTimes(const ComparisonRow& row, std::string& text) {
  text += fmt::format("\n{}: {}\n", row.name, row.description);
  text += fmt::format("  {:14}{:>11}{:>11}{:>9}{:>14}{:>11}{:>9}\n", "control step", "NMPC", "LPVMPC",
                      "ratio", "paper's NMPC", "LPVMPC", "ratio");
  const auto line = [&](const char* name, double StepTimes::*time) {
    const double nmpc = row.nmpc.times.*time, lpv = row.lpv.times.*time;
    const double paper_nmpc = row.paper_nmpc.*time, paper_lpv = row.paper_lpv.*time;
    text +=
        fmt::format("  {:14}{:>9.3f}ms{:>9.3f}ms{:>9.0f}{:>12.1f}ms{:>9.1f}ms{:>9.0f}\n", name, 1e3 * nmpc,
                    1e3 * lpv, nmpc / lpv, 1e3 * paper_nmpc, 1e3 * paper_lpv, paper_nmpc / paper_lpv);
  };
  line("average time", &StepTimes::average);
  line("maximum time", &StepTimes::maximum);
  line("minimum time", &StepTimes::minimum);
}

void AppendQuality(const PaperResult& result, std::string& text) {
  text += "\nTracking, smoothness and cost (by the NMPC's weights)\n";
  text += fmt::format("  {:12}{:8}{:>9}{:>13}{:>13}{:>12}{:>11}{:>11}{:>12}\n", "", "", "unsolved", "lateral",
                      "steering", "jerk", "clearance", "road", "cost");
  text += fmt::format("  {:12}{:8}{:>9}{:>13}{:>13}{:>12}{:>11}{:>11}{:>12}\n", "", "", "steps", "RMS [m]",
                      "RMS [rad/s]", "RMS [m/s3]", "", "margin [m]", "");
  for (const ComparisonRow& row : result.comparison) {
    const auto line = [&](const char* name, const ComparedDrive& drive) {
      const DriveFigures& f = drive.figures;
      text += fmt::format("  {:12}{:8}{:>9}{:>13.4f}{:>13.4f}{:>12.3f}{:>11}{:>11.2f}{:>12.2f}\n", row.name,
                          name, f.summary.infeasible_steps, f.summary.rms_lateral_error_m.value_or(0.0),
                          f.rms_steering_rate, f.rms_jerk, ClearanceText(f),
                          f.summary.min_road_margin_m.value_or(0.0), f.cost);
    };
    line("NMPC", row.nmpc);
    line("LPVMPC", row.lpv);
  }
  const ComparisonRow& largest = LargestCostGap(result);
  text += fmt::format("  largest cost gap of the LPVMPC to the NMPC: {} in {}\n",
                      PercentText(largest.cost_gap()), largest.name);
}

void AppendMap(const FeasibilityMap& map, std::string& text) {
  text +=
      "\nMap: feasible and clear (.), short by less than a centimetre (m), feasible but touching (t), off "
      "the road (r), infeasible (x); shift of the path up, speed across\n";
  for (const MapPanel& panel : map.panels) {
    text += fmt::format("\n  {}, N = {}: {} of {} clear\n", loop::ControllerName(panel.controller),
                        panel.horizon, panel.clear(), map.speeds.size() * map.shifts.size());
    for (std::size_t i = map.shifts.size(); i-- > 0;) {
      text += fmt::format("  {:4.1f} m ", map.shifts[i]);
      for (const CircleOutcome cell : panel.cells[i]) {
        constexpr std::string_view kSigns = ".mtrx";  // in the order of CircleOutcome
        text += fmt::format("  {}", kSigns.at(static_cast<std::size_t>(cell)));
      }
      text += '\n';
    }
    text += "         ";
    for (const double speed : map.speeds) text += fmt::format(" {:2.0f}", speed);
    text += " m/s\n";
  }
}

}  // namespace

std::string ToText(const PaperResult& result) {
  std::string text;
  AppendFeasibility(result, text);
  for (const ComparisonRow& row : result.comparison) AppendTimes(row, text);
  AppendQuality(result, text);
  if (result.map) AppendMap(*result.map, text);
  text += "\nClaims\n";
  for (const Claim& claim : JudgeClaims(result)) {
    text += fmt::format("  {:6}  {}: {}\n", claim.holds ? "holds" : "FAILS", claim.text, claim.seen);
  }
  text += fmt::format("\n{:.0f} s in all\n", result.seconds);
  return text;
}

}  // namespace tools
