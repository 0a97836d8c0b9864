#include "tools/report/report.hpp"

#include <stdexcept>

#include <nlohmann/json.hpp>

#include "config/text_file.hpp"
#include "tools/io/write_file.hpp"
#include "tools/report/drive_page.hpp"
#include "tools/report/report_page.hpp"

namespace tools {

void Report(const ReportOptions& options) {
  const std::filesystem::path data = options.run_dir / "report.json";
  const nlohmann::ordered_json page =
      std::filesystem::exists(data) ? ParseJson(data) : DrivePage(options.run_dir);
  if (!page.is_object() || !page.contains("title") || !page["title"].is_string()) {
    throw std::runtime_error(config::PlaceName(data) + ": contains no data of a page");
  }
  WriteFile(options.output, ReportPage(page["title"].get<std::string>(), page.dump()));
}

}  // namespace tools
