#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "tools/io/json_values.hpp"
#include "tools/paper/paper_result.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

ordered_json FeasibilityData(const FeasibilityDrive& drive) {
  const auto& failure = drive.figures.first_failure;
  ordered_json data{{"feasible", drive.feasible()},
                    {"infeasible_steps", drive.figures.summary.infeasible_steps},
                    {"min_clearance_m", OrNull(drive.figures.summary.min_clearance_m)},
                    {"largest_plan_change_m", drive.largest_plan_change},
                    {"first_infeasible_step", nullptr},
                    {"violated", nullptr}};
  if (failure) {
    data["first_infeasible_step"] = failure->step;
    data["violated"] = ToText(*failure);
  }
  return data;
}

ordered_json TimesData(const StepTimes& times) {
  return {{"average", times.average}, {"maximum", times.maximum}, {"minimum", times.minimum}};
}

ordered_json ComparedData(const ComparedDrive& drive, const StepTimes& paper) {
  const DriveFigures& f = drive.figures;
  return {{"times_s", TimesData(drive.times)},
          {"paper_times_s", TimesData(paper)},
          {"steps", f.summary.steps},
          {"infeasible_steps", f.summary.infeasible_steps},
          {"completed", f.summary.completed},
          {"rms_lateral_error_m", OrNull(f.summary.rms_lateral_error_m)},
          {"rms_steering_rate_rad_s", f.rms_steering_rate},
          {"rms_jerk_m_s3", f.rms_jerk},
          {"min_clearance_m", OrNull(f.summary.min_clearance_m)},
          {"min_road_margin_m", OrNull(f.summary.min_road_margin_m)},
          {"cost", f.cost}};
}

ordered_json MapData(const FeasibilityMap& map) {
  ordered_json panels = ordered_json::array();
  for (const MapPanel& panel : map.panels) {
    ordered_json limits = ordered_json::array();
    for (std::size_t i = 0; i < map.speeds.size(); ++i) limits.push_back(OrNull(map.Limit(panel, i)));
    panels.push_back({{"controller", loop::ControllerName(panel.controller)},
                      {"horizon", panel.horizon},
                      {"clear", panel.clear()},
                      {"limit_m", limits},
                      {"cells", CellData(panel)}});
  }
  return {{"speeds_m_s", map.speeds}, {"shifts_m", map.shifts}, {"panels", panels}};
}

}  // namespace

ordered_json CellData(const MapPanel& panel) {
  ordered_json cells = ordered_json::array();
  for (const auto& row : panel.cells) {
    ordered_json line = ordered_json::array();
    for (const CircleOutcome cell : row) line.push_back(NameOf(cell));
    cells.push_back(std::move(line));
  }
  return cells;
}

ordered_json ToJson(const PaperResult& result) {
  const std::vector<Claim> claims = JudgeClaims(result);
  ordered_json data{{"claims", ordered_json::array()},
                    {"feasibility", ordered_json::array()},
                    {"comparison", ordered_json::array()}};
  for (const Claim& claim : claims) {
    data["claims"].push_back({{"text", claim.text}, {"seen", claim.seen}, {"holds", claim.holds}});
  }
  for (const FeasibilityRow& row : result.feasibility) {
    data["feasibility"].push_back({{"scenario", row.number},
                                   {"description", row.description},
                                   {"lpv-standard", FeasibilityData(row.standard)},
                                   {"lpv", FeasibilityData(row.trust_region)}});
  }
  for (const ComparisonRow& row : result.comparison) {
    data["comparison"].push_back({{"scenario", row.name},
                                  {"nmpc", ComparedData(row.nmpc, row.paper_nmpc)},
                                  {"lpv", ComparedData(row.lpv, row.paper_lpv)},
                                  {"speedup", row.speedup()},
                                  {"cost_gap", row.cost_gap()}});
  }
  const ComparisonRow& largest = LargestCostGap(result);
  data["largest_cost_gap"] = {{"scenario", largest.name}, {"cost_gap", largest.cost_gap()}};
  data["map"] = result.map ? MapData(*result.map) : ordered_json(nullptr);
  data["seconds"] = result.seconds;
  data["passed"] = std::ranges::all_of(claims, &Claim::holds);
  return data;
}

}  // namespace tools
