#include <algorithm>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/paper/paper_result.hpp"
#include "tools/report/report_data.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

ordered_json Judged(const std::string& text, bool good) {
  return {{"text", text}, {"verdict", good ? "good" : "bad"}};
}

ordered_json ClaimsSection(const PaperResult& result) {
  ordered_json items = ordered_json::array();
  for (const Claim& claim : JudgeClaims(result)) {
    items.push_back(
        {{"label", claim.text}, {"value", claim.seen}, {"verdict", claim.holds ? "good" : "bad"}});
  }
  return {{"type", "figures"}, {"title", "Claims"}, {"paragraphs", ordered_json::array()}, {"items", items}};
}

ordered_json FeasibilitySection(const PaperResult& result) {
  const auto outcome = [](const FeasibilityDrive& drive) {
    return Judged(OutcomeText(drive), drive.feasible());
  };
  ordered_json rows = ordered_json::array();
  for (const FeasibilityRow& row : result.feasibility) {
    rows.push_back({row.number, row.description, outcome(row.standard), outcome(row.trust_region),
                    fmt::format("{:.2f}", row.standard.largest_plan_change),
                    fmt::format("{:.2f}", row.trust_region.largest_plan_change),
                    ClearanceText(row.trust_region.figures)});
  }
  return {
      {"type", "table"},
      {"title", "Feasibility: standard LPVMPC against LPVMPC with scheduling trust region"},
      {"paragraphs",
       {"Ten drives on a circular road past an obstacle. Of a drive that becomes infeasible: the first step, "
        "and the constraint that would have to give way most if all on the states could give way."}},
      {"columns",
       {"No.", "scenario", "standard", "trust region", "plan change [m], standard",
        "plan change [m], trust region", "clearance"}},
      {"rows", rows},
      {"note",
       "Plan change: the greatest distance between where two plans that follow on each other see the vehicle "
       "at the same time, up to the first infeasible step. Clearance: of the centre of gravity from the "
       "obstacle itself; controllers see it enlarged by 0.1 m."}};
}

// The paper's fig. openloop_standard_LPVMPC and openloop_LPVMPC_trust_region, for the first scenario in which the
// standard LPVMPC fails a step and the other is feasible.
void AddFans(const PaperResult& result, ordered_json& page) {
  constexpr std::size_t kBefore = 6, kAfter = 4, kAround = 40;  // samples
  const auto row = std::ranges::find_if(result.feasibility, [](const FeasibilityRow& r) {
    return r.standard.figures.first_failure && r.trust_region.feasible();
  });
  if (row == result.feasibility.end()) return;
  const std::size_t failed = SampleOfStep(row->standard.record, row->standard.figures.first_failure->step);
  const std::size_t first = failed - std::min(failed, kBefore + kAround);
  const std::size_t from = failed - std::min(failed, kBefore) - first, to = failed + kAfter - first;
  page["roads"]["circle"] = RoadData(row->road);
  ordered_json fans = ordered_json::array();
  const auto add = [&](const char* key, const char* name, const FeasibilityDrive& drive) {
    const DriveRecord record = Excerpt(drive.record, first, failed + kAfter + kAround);
    page["drives"][key] = DriveData(record, {.name = name, .road_key = "circle"}, drive.config, row->road);
    fans.push_back({{"title", name}, {"drive", key}, {"from", from}, {"to", to}});
  };
  add("fan-standard", "standard LPVMPC", row->standard);
  add("fan-trust-region", "LPVMPC with trust region", row->trust_region);
  page["sections"].push_back({{"type", "fans"},
                              {"title", "Open-loop predictions at consecutive steps"},
                              {"paragraphs",
                               {fmt::format("Scenario {}: what both controllers planned at the same steps, "
                                            "about the one at which the standard LPVMPC becomes infeasible.",
                                            row->number)}},
                              {"fans", fans}});
}

ordered_json TimesTable(const ComparisonRow& row) {
  ordered_json rows = ordered_json::array();
  const auto add = [&](const char* name, double StepTimes::*time, bool judged) {
    const double nmpc = row.nmpc.times.*time, lpv = row.lpv.times.*time;
    const double paper_nmpc = row.paper_nmpc.*time, paper_lpv = row.paper_lpv.*time;
    const std::string ratio = fmt::format("{:.0f}", nmpc / lpv);
    rows.push_back({name, fmt::format("{:.3f}", 1e3 * nmpc), fmt::format("{:.4f}", 1e3 * lpv),
                    judged ? Judged(ratio, nmpc / lpv >= kLeastSpeedup) : ordered_json(ratio),
                    fmt::format("{:.1f}", 1e3 * paper_nmpc), fmt::format("{:.1f}", 1e3 * paper_lpv),
                    fmt::format("{:.0f}", paper_nmpc / paper_lpv)});
  };
  add("average", &StepTimes::average, true);
  add("maximum", &StepTimes::maximum, false);
  add("minimum", &StepTimes::minimum, false);
  return {{"type", "table"},
          {"title", ""},
          {"paragraphs", ordered_json::array()},
          {"columns",
           {"control step", "NMPC [ms]", "LPVMPC [ms]", "ratio", "paper: NMPC [ms]", "paper: LPVMPC [ms]",
            "paper: ratio"}},
          {"rows", rows},
          {"note",
           "Of each step the least of its repetitions; the plots above show one step in four, and every step "
           "near an obstacle. The paper's figures are from another machine, in Matlab."}};
}

void AddComparison(const PaperResult& result, ordered_json& page) {
  for (const ComparisonRow& row : result.comparison) {
    page["roads"][row.name] = RoadData(row.road);
    ordered_json keys = ordered_json::array();
    const auto add = [&](const char* name, const ComparedDrive& drive) {
      const std::string key = row.name + " " + name;
      page["drives"][key] =
          DriveData(Thinned(drive.record), {.name = name, .road_key = row.name}, drive.config, row.road);
      keys.push_back(key);
    };
    add("NMPC", row.nmpc);
    add("LPVMPC", row.lpv);
    page["sections"].push_back(
        {{"type", "drives"}, {"title", row.name}, {"paragraphs", {row.description + "."}}, {"drives", keys}});
    page["sections"].push_back(TimesTable(row));
  }
}

ordered_json QualitySection(const PaperResult& result) {
  ordered_json rows = ordered_json::array();
  for (const ComparisonRow& row : result.comparison) {
    const auto add = [&](const char* name, const ComparedDrive& drive, const std::string& gap) {
      const DriveFigures& f = drive.figures;
      rows.push_back({row.name, name, std::to_string(f.summary.infeasible_steps),
                      fmt::format("{:.4f}", f.summary.rms_lateral_error_m.value_or(0.0)),
                      fmt::format("{:.4f}", f.rms_steering_rate), fmt::format("{:.3f}", f.rms_jerk),
                      ClearanceText(f), fmt::format("{:.2f}", f.cost), gap});
    };
    add("NMPC", row.nmpc, "");
    add("LPVMPC", row.lpv, PercentText(row.cost_gap()));
  }
  const ComparisonRow& largest = LargestCostGap(result);
  return {
      {"type", "table"},
      {"title", "Tracking, smoothness, cost"},
      {"paragraphs",
       {fmt::format(
           "The cost is that of the whole drive as it went, by the NMPC's weights. Largest gap: {} in {}.",
           PercentText(largest.cost_gap()), largest.name)}},
      {"columns",
       {"scenario", "controller", "unsolved steps", "lateral error, RMS [m]", "steering rate, RMS [rad/s]",
        "jerk, RMS [m/s³]", "clearance", "cost", "gap"}},
      {"rows", rows},
      {"note", ""}};
}

void AddMap(const PaperResult& result, ordered_json& page) {
  const FeasibilityMap& map = *result.map;
  ordered_json panels = ordered_json::array(), marks = ordered_json::array(), limits = ordered_json::array();
  for (std::size_t p = 0; p < map.panels.size(); ++p) {
    const MapPanel& panel = map.panels[p];
    const std::string controller = loop::ControllerName(panel.controller);
    panels.push_back({{"title", fmt::format("{}, N = {}: {} of {} clear", controller, panel.horizon,
                                            panel.clear(), map.speeds.size() * map.shifts.size())},
                      {"cells", CellData(panel)}});
    ordered_json limit{controller, std::to_string(panel.horizon)};
    for (std::size_t i = 0; i < map.speeds.size(); ++i) {
      const auto reached = map.Limit(panel, i);
      limit.push_back(reached ? fmt::format("{:.1f}", *reached) : "-");
    }
    limits.push_back(limit);
    if (panel.controller == loop::ControllerKind::kNmpc) continue;
    for (const FeasibilityRow& row : result.feasibility) {
      if (row.trust_region.config.mpc.horizon != panel.horizon) continue;
      marks.push_back({{"speed", row.speed}, {"shift", row.shift}, {"panel", p}, {"label", row.number}});
    }
  }
  ordered_json columns{"controller", "N"};
  for (const double speed : map.speeds) columns.push_back(fmt::format("{:.0f} m/s", speed));
  page["sections"].push_back(
      {{"type", "map"},
       {"title", "The map behind the ten"},
       {"paragraphs",
        {"A left bend of 100 m radius, an obstacle of 1 m radius passed on the inside, every speed, sideways "
         "shift and horizon: where each controller solves every step and does not touch. Numbers mark where "
         "the ten scenarios lie (their radii and sides differ)."}},
       {"speeds", map.speeds},
       {"shifts", map.shifts},
       {"panels", panels},
       {"marks", marks}});
  page["sections"].push_back({{"type", "table"},
                              {"title", "Where the regime ends"},
                              {"paragraphs",
                               {"The greatest shift [m] up to which, from the smallest on, every drive of "
                                "that speed is clear; a single step that misses by a millimetre ends it."}},
                              {"columns", columns},
                              {"rows", limits},
                              {"note", ""}});
}

}  // namespace

ordered_json PaperPage(const PaperResult& result) {
  ordered_json page{{"title", "The paper's results reproduced"},
                    {"subtitle",
                     "Obstacle Avoidance of Autonomous Vehicles: An LPVMPC with Scheduling Trust Region "
                     "(Nezami, Karachalios, Schildbach, Abbas 2024), by lpvmpc paper"},
                    {"roads", ordered_json::object()},
                    {"drives", ordered_json::object()},
                    {"sections", ordered_json::array()}};
  page["sections"].push_back(ClaimsSection(result));
  page["sections"].push_back(FeasibilitySection(result));
  AddFans(result, page);
  AddComparison(result, page);
  page["sections"].push_back(QualitySection(result));
  if (result.map) AddMap(result, page);
  return page;
}

}  // namespace tools
