#include "tools/sweep/sweep.hpp"

#include <nlohmann/json.hpp>

#include "tools/io/write_file.hpp"
#include "tools/report/report.hpp"
#include "tools/sweep/drive_sweep.hpp"
#include "tools/sweep/merge_parts.hpp"

namespace tools {
namespace {

void WriteResult(const SweepResult& result, bool as_json, const std::filesystem::path& folder,
                 std::ostream& out) {
  nlohmann::ordered_json figures = ToJson(result);
  const nlohmann::ordered_json timing = TimingJson(result);
  if (!folder.empty()) {
    WriteFile(folder / "sweep.json", figures.dump(2) + "\n");
    WriteFile(folder / "timing.json", timing.dump(2) + "\n");
    WriteFile(folder / "report.json", SweepPage(result).dump());
    Report({.run_dir = folder, .output = folder / "report.html"});
  }
  if (as_json) {
    figures["timing"] = timing;
    out << figures.dump(2) << '\n';
  } else {
    out << ToText(result);
    if (!folder.empty()) out << "report: " << (folder / "report.html").string() << '\n';
  }
}

}  // namespace

void Sweep(const SweepOptions& options, std::ostream& out) {
  CheckSetup(options.setup);
  if (!options.shard) {
    if (!options.out.empty()) MakeFolder(options.out);
    WriteResult(DriveSweep(options.setup, {}, options.jobs).result, options.json, options.out, out);
    return;
  }
  const std::string part = PartJson(DriveSweep(options.setup, *options.shard, options.jobs)).dump(2) + "\n";
  if (options.out.empty()) {
    out << part;
  } else {
    WriteFile(options.out, part);
  }
}

void MergeSweep(const SweepMergeOptions& options, std::ostream& out) {
  const SweepResult result = MergeParts(options.parts);
  if (!options.out.empty()) MakeFolder(options.out);
  WriteResult(result, options.json, options.out, out);
}

}  // namespace tools
