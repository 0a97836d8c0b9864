#include "config/waypoint_file.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <sstream>
#include <string>

#include "config/text_file.hpp"

namespace config {
namespace {

constexpr std::array<std::string_view, 2> kColumns{"X", "Y"};
constexpr double kLargest = 1e6;  // [m]

std::string_view Trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> Split(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(Trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

// Spreadsheets begin UTF-8 files with a byte order mark.
std::string WithoutByteOrderMark(std::string text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

double ToNumber(const std::string& place, std::string_view column, std::string_view field) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) {
    throw ConfigError(
        fmt::format("{} column '{}' = \"{}\" is not a number", place, column, Printable(field)));
  }
  if (std::abs(value) > kLargest) {
    throw ConfigError(
        fmt::format("{} column '{}' = {} is outside [{}, {}] m", place, column, value, -kLargest, kLargest));
  }
  return value;
}

}  // namespace

std::vector<Eigen::Vector2d> LoadWaypoints(const std::filesystem::path& file) {
  std::istringstream text(WithoutByteOrderMark(ReadTextFile(file)));
  std::vector<Eigen::Vector2d> waypoints;
  bool header_seen = false;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    if (Trim(line).empty()) continue;
    const std::string place = fmt::format("{}:{}:", PlaceName(file), number);
    const std::vector<std::string_view> fields = Split(line);
    if (!header_seen) {
      if (fields.size() != 2 || fields[0] != kColumns[0] || fields[1] != kColumns[1]) {
        throw ConfigError(fmt::format("{} \"{}\" must be the header \"X,Y\"", place, Printable(Trim(line))));
      }
      header_seen = true;
      continue;
    }
    if (fields.size() != 2)
      throw ConfigError(fmt::format("{} has {} columns, must be X,Y", place, fields.size()));
    const Eigen::Vector2d point(ToNumber(place, kColumns[0], fields[0]),
                                ToNumber(place, kColumns[1], fields[1]));
    if (!waypoints.empty() && point == waypoints.back()) {
      throw ConfigError(
          fmt::format("{} waypoint {},{} repeats its predecessor", place, point.x(), point.y()));
    }
    waypoints.push_back(point);
  }
  if (waypoints.size() < 2) {
    throw ConfigError(
        fmt::format("{}: has {} waypoints, must be at least 2", PlaceName(file), waypoints.size()));
  }
  return waypoints;
}

}  // namespace config
