#include "tools/falsify/falsify.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

#include "tools/falsify/cross_entropy.hpp"
#include "tools/io/process_pool.hpp"
#include "tools/io/progress_bar.hpp"
#include "tools/io/write_file.hpp"
#include "tools/scenarios/scenario_seed.hpp"
#include "tools/shards/read_parts.hpp"

namespace tools {
namespace {

using Points = std::vector<CrossEntropy::Point>;

TrafficPoint PointOf(const CrossEntropy::Point& coordinates) {
  TrafficPoint point;
  std::ranges::copy(coordinates, point.begin());
  return OnGrid(point);
}

std::vector<std::optional<double>> Margins(const Points& points, const FalsifySetup& setup, int jobs,
                                           ProgressBar& bar) {
  const auto drive = [&](std::size_t i) {
    const std::optional<double> margin = DriveMargin(PointOf(points[i]), setup);
    return margin ? fmt::format("{:a}", *margin) : "";  // exact
  };
  std::vector<std::optional<double>> margins;
  for (const std::string& text : MapInProcesses(points.size(), jobs, drive, [&] { bar.Advance(); }))
    margins.push_back(text.empty() ? std::nullopt : std::optional(std::stod(text)));
  return margins;
}

// The points that count, by increasing margin.
std::vector<std::pair<double, CrossEntropy::Point>> Ranked(
    const Points& points, const std::vector<std::optional<double>>& margins) {
  std::vector<std::pair<double, CrossEntropy::Point>> ranked;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (margins[i]) ranked.emplace_back(*margins[i], points[i]);
  }
  std::ranges::stable_sort(ranked, {}, [](const auto& entry) { return entry.first; });
  return ranked;
}

FalsifySearch RunSearch(const FalsifySetup& setup, int index, int jobs, ProgressBar& bar) {
  CrossEntropy method(kTrafficDimensions, ScenarioSeed(setup.seed, static_cast<std::uint64_t>(index)));
  FalsifySearch search{.index = index, .least = {}, .worst = {}};
  std::optional<std::pair<double, CrossEntropy::Point>> worst;
  for (int left = setup.DrivesOf(index); left > 0; left -= kGeneration) {
    bar.Name(fmt::format("search {}{}", index, worst ? fmt::format(", {:.3f} m", worst->first) : ""));
    Points points;
    for (int i = 0; i < std::min(left, kGeneration); ++i) points.push_back(method.Draw());
    const std::vector<std::optional<double>> margins = Margins(points, setup, jobs, bar);
    const auto ranked = Ranked(points, margins);
    search.impossible += static_cast<int>(points.size() - ranked.size());
    search.violated +=
        static_cast<int>(std::ranges::count_if(ranked, [](const auto& entry) { return entry.first < 0.0; }));
    search.least.emplace_back();
    if (ranked.empty()) continue;
    search.least.back() = ranked.front().first;
    if (!worst || ranked.front().first < worst->first) worst = ranked.front();
    Points elite;
    for (std::size_t i = 0; i < std::min<std::size_t>(ranked.size(), kElite); ++i)
      elite.push_back(ranked[i].second);
    method.Learn(elite);
  }
  if (worst) search.worst = FindingOf(PointOf(worst->second), worst->first, setup);
  return search;
}

void WriteResult(const FalsifyResult& result, int worst, bool as_json, const std::filesystem::path& file,
                 std::ostream& out) {
  const std::string figures = ToJson(result).dump(2) + "\n";
  if (!file.empty()) WriteFile(file, figures);
  out << (as_json ? figures : ToText(result, static_cast<std::size_t>(worst)));
}

}  // namespace

FalsifyPart RunSearches(const FalsifySetup& setup, const Shard& shard, int jobs) {
  FalsifyPart part{.result = {.setup = setup, .searches = {}}, .shard = shard};
  const std::vector<int> indices = shard.Indices(setup.Searches());
  std::size_t drives = 0;
  for (const int index : indices) drives += static_cast<std::size_t>(setup.DrivesOf(index));
  ProgressBar bar(drives);
  for (const int index : indices) part.result.searches.push_back(RunSearch(setup, index, jobs, bar));
  return part;
}

void Falsify(const FalsifyOptions& options, std::ostream& out) {
  CheckSetup(options.setup);
  const FalsifyPart part = RunSearches(options.setup, options.shard.value_or(Shard{}), options.jobs);
  if (!options.shard) {
    WriteResult(part.result, options.worst, options.json, options.out, out);
    return;
  }
  const std::string text = PartJson(part).dump(2) + "\n";
  if (options.out.empty()) {
    out << text;
  } else {
    WriteFile(options.out, text);
  }
}

void MergeFalsify(const FalsifyMergeOptions& options, std::ostream& out) {
  std::vector<FalsifyPart> parts = ReadParts(options.parts, "falsification", FalsifyPartOf);
  FalsifyResult whole = std::move(parts.front().result);
  for (std::size_t i = 1; i < parts.size(); ++i)
    std::ranges::move(parts[i].result.searches, std::back_inserter(whole.searches));
  std::ranges::sort(whole.searches, {}, &FalsifySearch::index);
  WriteResult(whole, options.worst, options.json, options.out, out);
}

}  // namespace tools
