#include "tools/catalogue/open_list.hpp"

#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

#include "config/text_file.hpp"

namespace tools {

std::map<std::string, std::string> LoadOpenList(const std::filesystem::path& catalogue) {
  const std::filesystem::path file = catalogue / "open.txt";
  std::map<std::string, std::string> open;
  if (!std::filesystem::exists(file)) return open;
  std::ifstream lines = config::OpenTextFile(file);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto fail = [&](const char* reason) {
      throw std::runtime_error(
          fmt::format("{}:{}: '{}' {}", config::PlaceName(file), number, config::Printable(line), reason));
    };
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos || colon + 2 == line.size()) fail("is not \"NAME: WHAT FAILS\"");
    const std::string name = line.substr(0, colon);
    if (!std::filesystem::exists(catalogue / name / "scenario.toml")) fail("names no scenario of the folder");
    if (!open.emplace(name, line.substr(colon + 2)).second) fail("repeats a scenario");
  }
  return open;
}

}  // namespace tools
