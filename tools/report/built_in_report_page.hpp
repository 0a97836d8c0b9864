// The page of a report with all scripts and styles inside, and in it once each, title first, where they belong:
//   @TITLE@  text of the title, as HTML
//   @DATA@   JSON inside of a script element
#pragma once

#include <string_view>

namespace tools {

[[nodiscard]] std::string_view BuiltInReportPage();

}  // namespace tools
