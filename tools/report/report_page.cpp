#include "tools/report/report_page.hpp"

#include <string_view>

#include "tools/report/built_in_report_page.hpp"

namespace tools {
namespace {

std::string EscapedHtml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

// In JSON `<` occurs only inside strings, where the escape is equivalent.
std::string EscapedJson(std::string_view json) {
  std::string escaped;
  escaped.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace

std::string ReportPage(const std::string& title, const std::string& json) {
  static constexpr std::string_view kTitle = "@TITLE@";
  static constexpr std::string_view kData = "@DATA@";
  const std::string_view page = BuiltInReportPage();
  const std::size_t title_at = page.find(kTitle);
  const std::size_t data_at = page.find(kData);

  std::string filled(page.substr(0, title_at));
  filled += EscapedHtml(title);
  filled += page.substr(title_at + kTitle.size(), data_at - title_at - kTitle.size());
  filled += EscapedJson(json);
  filled += page.substr(data_at + kData.size());
  return filled;
}

}  // namespace tools
