#include "tools/catalogue/catalogue.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "tools/catalogue/catalogue_page.hpp"
#include "tools/catalogue/drive_catalogue.hpp"
#include "tools/io/write_file.hpp"
#include "tools/report/report_page.hpp"

namespace tools {
namespace {

std::string OrDash(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string ToText(const std::vector<CatalogueDrive>& drives) {
  std::string text = fmt::format("{:28}{:15}{:>10}{:>10}{:>11}{:>12}{:>14}{:>10}\n", "scenario", "outcome",
                                 "clearance", "margin", "standstill", "over speed", "steering RMS", "time");
  text += fmt::format("{:43}{:>10}{:>10}{:>11}{:>12}{:>14}{:>10}\n", "", "[m]", "[m]", "[s]", "[m/s]",
                      "[rad/s]", "[s]");
  for (const CatalogueDrive& drive : drives) {
    text += fmt::format("{:28}{:15}{:>10}{:>10}{:>11.1f}{:>12}{:>14}{:>10.1f}\n", drive.name,
                        NameOf(drive.outcome), OrDash(drive.min_clearance_m), OrDash(drive.min_road_margin_m),
                        drive.longest_free_standstill_s, OrDash(drive.max_speed_excess_mps),
                        OrDash(drive.rms_steering_rate), drive.duration);
  }
  text += '\n';
  for (const CatalogueDrive& drive : drives) {
    if (drive.failed_expectations.empty()) continue;
    text += fmt::format("{}, {}: {}\n", drive.name, NameOf(drive.outcome),
                        fmt::join(drive.failed_expectations, "; "));
  }
  const auto count = [&drives](CatalogueOutcome outcome) {
    return std::count_if(drives.begin(), drives.end(),
                         [outcome](const CatalogueDrive& drive) { return drive.outcome == outcome; });
  };
  text += fmt::format("{} passed, {} failed, {} open, {} no longer open\n", count(CatalogueOutcome::kPassed),
                      count(CatalogueOutcome::kFailed), count(CatalogueOutcome::kOpen),
                      count(CatalogueOutcome::kNoLongerOpen));
  return text;
}

std::string ToJson(const std::vector<CatalogueDrive>& drives) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const CatalogueDrive& drive : drives) {
    array.push_back({{"name", drive.name},
                     {"description", drive.description},
                     {"outcome", NameOf(drive.outcome)},
                     {"open", drive.open},
                     {"duration", drive.duration},
                     {"summary", nlohmann::ordered_json::parse(drive.summary)}});
  }
  return array.dump(2) + '\n';
}

}  // namespace

int Catalogue(const CatalogueOptions& options, std::ostream& out) {
  const bool shown = !options.report.empty();
  const std::vector<CatalogueDrive> drives =
      DriveCatalogue(options.folder, options.filter, options.jobs, shown);
  if (!options.json.empty()) WriteFile(options.json, ToJson(drives));
  if (shown) WriteFile(options.report, ReportPage("Catalogue", CataloguePage(drives).dump()));
  out << ToText(drives);
  const bool failed = std::any_of(drives.begin(), drives.end(), [](const CatalogueDrive& drive) {
    return drive.outcome == CatalogueOutcome::kFailed;
  });
  return failed ? 1 : 0;
}

}  // namespace tools
