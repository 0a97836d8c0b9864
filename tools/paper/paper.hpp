// `lpvmpc paper`: the paper's comparisons driven anew, and whether its claims hold.
#pragma once

#include <filesystem>
#include <ostream>

namespace tools {

struct PaperOptions {
  std::filesystem::path scenarios;  // folder with the scenarios
  std::filesystem::path out;        // folder for report.html, report.json and paper.json; empty: none
  bool map = false;                 // sweep speed, shift and horizon too
  int jobs = 1;                     // processes of the map
  int repeat = 3;                   // drives whose least step times count
  bool json = false;
};

// Writes the tables, or with `json` all figures, to `out`. Returns 0 if all claims hold, 1 if one does not. Throws one
// line: a file is missing or wrong, or the folder cannot be written.
[[nodiscard]] int Paper(const PaperOptions& options, std::ostream& out);

}  // namespace tools
