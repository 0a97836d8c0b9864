// The page of a report with all scripts and styles inlined. It contains two placeholders, once each, in this order:
//   @TITLE@  the title's text, as HTML
//   @DATA@   JSON inside a script element
#pragma once

#include <string_view>

namespace tools {

[[nodiscard]] std::string_view BuiltInReportPage();

}  // namespace tools
