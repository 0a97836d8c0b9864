// `lpvmpc paper`: repeats the paper's comparisons and judges whether its claims hold.
#pragma once

#include <filesystem>
#include <ostream>

namespace tools {

struct PaperOptions {
  std::filesystem::path scenarios;  // folder with the scenarios
  std::filesystem::path out;        // folder for report.html, report.json and paper.json; empty: none
  bool map = false;                 // also sweep speed, shift and horizon
  int jobs = 1;                     // processes for the map
  int repeat = 3;                   // drives per comparison; the least time of each step counts
  bool json = false;
};

// Writes the tables, or with `json` all figures, to `out`. Returns 0 if all claims hold, 1 if one does not. Throws an
// exception with a one-line message if a file is missing or wrong, or if the folder cannot be written.
[[nodiscard]] int Paper(const PaperOptions& options, std::ostream& out);

}  // namespace tools
