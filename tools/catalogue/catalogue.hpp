// `lpvmpc catalogue`: drives all scenarios of a catalogue and compares them with their expectations.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

namespace tools {

struct CatalogueOptions {
  std::filesystem::path folder;
  std::string filter;  // drive only those whose name contains it
  int jobs = 1;        // processes
  // File for an array with, for each drive, its name, description, outcome, "open" (what is known to fail), duration
  // [s] and summary (sim::ToJson); empty: none.
  std::filesystem::path json;
  std::filesystem::path report;  // file for the page about all drives (catalogue_page.hpp); empty: none
};

// Writes a table to `out`, and below it the expectations that are not met. Returns 1 if a scenario fails that is not
// listed as open, else 0. Throws an exception with a one-line message on bad input, or if a file cannot be written.
[[nodiscard]] int Catalogue(const CatalogueOptions& options, std::ostream& out);

}  // namespace tools
