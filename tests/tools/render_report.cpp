// Reads a report's JSON from stdin and writes its page to stdout.
//   render_report TITLE
#include <iostream>
#include <iterator>
#include <string>

#include "tools/report/report_page.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string json{std::istreambuf_iterator<char>(std::cin), {}};
  std::cout << tools::ReportPage(argv[1], json) << std::flush;
  return std::cout ? 0 : 1;
}
