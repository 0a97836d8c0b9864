#include "tools/paper/paper.hpp"

#include <chrono>

#include <nlohmann/json.hpp>

#include "tools/io/write_file.hpp"
#include "tools/paper/paper_result.hpp"
#include "tools/report/report.hpp"

namespace tools {

int Paper(const PaperOptions& options, std::ostream& out) {
  if (!options.out.empty()) MakeFolder(options.out);
  const auto start = std::chrono::steady_clock::now();
  PaperResult result;
  {
    const std::size_t drives = std::size_t{2} * kFeasibilityScenarios +
                               std::size_t{2} * kComparisons * static_cast<std::size_t>(options.repeat);
    ProgressBar bar(drives + (options.map ? MapDrives() : 0));
    result.feasibility = CompareFeasibility(options.scenarios / "feasibility", bar);
    result.comparison = CompareWithNmpc(options.scenarios, options.repeat, bar);
    if (options.map) result.map = MapFeasibility(options.jobs, bar);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  const nlohmann::ordered_json figures = ToJson(result);
  out << (options.json ? figures.dump(2) + "\n" : ToText(result));
  if (!options.out.empty()) {
    WriteFile(options.out / "paper.json", figures.dump(2) + "\n");
    WriteFile(options.out / "report.json", PaperPage(result).dump());
    Report({.run_dir = options.out, .output = options.out / "report.html"});
    if (!options.json) out << "report: " << (options.out / "report.html").string() << '\n';
  }
  return figures.at("passed") ? 0 : 1;
}

}  // namespace tools
