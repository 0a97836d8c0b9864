// Drives the scenarios of a catalogue: a folder whose folders each hold a scenario.toml that names its route and the
// daemon's configuration.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tools {

enum class CatalogueOutcome {
  kPassed,        // every expectation is met
  kFailed,        // at least one is not
  kOpen,          // likewise, and the scenario is listed as open
  kNoLongerOpen,  // listed as open, but every expectation is met
};
[[nodiscard]] const char* NameOf(CatalogueOutcome outcome);

struct CatalogueDrive {
  std::string name;         // of the scenario's folder
  std::string description;  // as in scenario.toml
  CatalogueOutcome outcome = CatalogueOutcome::kPassed;
  std::string open;     // what fails according to the list of open scenarios; "" if the scenario is not in it
  std::string summary;  // sim::ToJson
  // The figures of the summary that the table shows.
  std::vector<std::string> failed_expectations;
  std::optional<double> min_clearance_m;
  std::optional<double> min_road_margin_m;
  double longest_free_standstill_s = 0.0;
  std::optional<double> max_speed_excess_mps;
  std::optional<double> rms_steering_rate;  // [rad/s]
  double duration = 0.0;                    // simulated time from engagement on [s]
  std::string shown;                        // its part of a page (ShownDrive); "" if it is not to be shown
};

// The names of the scenarios' folders that contain `filter`, in order. Throws std::invalid_argument if there are none.
[[nodiscard]] std::vector<std::string> ScenariosIn(const std::filesystem::path& folder,
                                                   const std::string& filter);

// Drives those scenarios whose folder's name contains `filter`, `jobs` at a time, each in its own process, and returns
// them by name; with `shown`, each with its part of a page. Throws std::invalid_argument if there are none;
// config::ConfigError or std::runtime_error, with a one-line message, if a file is missing or wrong.
[[nodiscard]] std::vector<CatalogueDrive> DriveCatalogue(const std::filesystem::path& folder,
                                                         const std::string& filter, int jobs, bool shown);

}  // namespace tools
