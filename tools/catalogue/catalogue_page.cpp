#include "tools/catalogue/catalogue_page.hpp"

#include <algorithm>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/report/report_data.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

const char* VerdictOf(CatalogueOutcome outcome) {
  const bool good = outcome == CatalogueOutcome::kPassed || outcome == CatalogueOutcome::kNoLongerOpen;
  return good ? "good" : "bad";
}

std::string OrDash(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

ordered_json ExpectationsSection(const sim::Summary& summary, const sim::Expectations& expect) {
  ordered_json rows = ordered_json::array();
  for (const sim::JudgedExpectation& expectation : sim::JudgeExpectations(summary, expect)) {
    rows.push_back(
        {expectation.figure, expectation.expected,
         ordered_json{{"text", expectation.measured}, {"verdict", expectation.met() ? "good" : "bad"}}});
  }
  return {{"type", "table"},
          {"title", ""},
          {"paragraphs", ordered_json::array()},
          {"columns", {"figure", "expected", "measured"}},
          {"rows", rows},
          {"note", ""}};
}

ordered_json OverviewSection(const std::vector<CatalogueDrive>& drives) {
  ordered_json rows = ordered_json::array();
  for (const CatalogueDrive& drive : drives) {
    rows.push_back(
        {drive.name, ordered_json{{"text", NameOf(drive.outcome)}, {"verdict", VerdictOf(drive.outcome)}},
         drive.description, OrDash(drive.min_clearance_m), OrDash(drive.min_road_margin_m),
         fmt::format("{:.1f}", drive.longest_free_standstill_s), fmt::format("{:.1f}", drive.duration)});
  }
  return {
      {"type", "table"},
      {"title", "Overview"},
      {"paragraphs", ordered_json::array()},
      {"columns",
       {"scenario", "outcome", "purpose", "clearance [m]", "road margin [m]", "standstill [s]", "time [s]"}},
      {"rows", rows},
      {"note",
       "Open: listed as not yet as expected. Standstill: the longest at a time while the way was free."}};
}

ordered_json DriveSection(const CatalogueDrive& drive, const ordered_json& expectations) {
  ordered_json paragraphs{drive.description};
  if (!drive.open.empty()) paragraphs.push_back(fmt::format("Listed as open: {}.", drive.open));
  return {{"type", "fold"},
          {"title", fmt::format("{}: {}", drive.name, NameOf(drive.outcome))},
          {"verdict", VerdictOf(drive.outcome)},
          {"paragraphs", paragraphs},
          {"sections",
           {expectations,
            {{"type", "drives"},
             {"title", ""},
             {"paragraphs", ordered_json::array()},
             {"drives", {drive.name}}}}}};
}

}  // namespace

ordered_json ShownDrive(const DriveRecord& record, const sim::Scenario& scenario, const loop::Config& config,
                        const config::RouteFile& road, const sim::Summary& summary) {
  constexpr std::size_t kOneIn = 2;
  const DriveLabel label{.name = loop::ControllerName(config.controller),
                         .road_key = scenario.name,
                         .footprint = scenario.footprint};
  return {{"road", RoadData(road)},
          {"drive", DriveData(Coarse(record, kOneIn), label, config, road)},
          {"expectations", ExpectationsSection(summary, scenario.expect)}};
}

ordered_json CataloguePage(const std::vector<CatalogueDrive>& drives) {
  const auto failed = std::ranges::count(drives, CatalogueOutcome::kFailed, &CatalogueDrive::outcome);
  const auto open = std::ranges::count(drives, CatalogueOutcome::kOpen, &CatalogueDrive::outcome);
  ordered_json page{
      {"title", "Catalogue"},
      {"subtitle", fmt::format("{} scenarios, {} failed, {} open", drives.size(), failed, open)},
      {"roads", ordered_json::object()},
      {"drives", ordered_json::object()},
      {"sections", {OverviewSection(drives)}}};
  for (const CatalogueDrive& drive : drives) {
    ordered_json shown = ordered_json::parse(drive.shown);
    shown["drive"]["road"] = drive.name;  // folders, not scenarios, have unique names
    page["roads"][drive.name] = std::move(shown["road"]);
    page["drives"][drive.name] = std::move(shown["drive"]);
    page["sections"].push_back(DriveSection(drive, shown["expectations"]));
  }
  return page;
}

}  // namespace tools
