#include "config/waypoint_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <span>
#include <sstream>
#include <string>

#include "config/route_limits.hpp"
#include "config/text_file.hpp"

namespace config {
namespace {

enum class Quantity { kX, kY, kLeft, kRight, kSpeed };

struct Column {
  std::string_view name;
  Quantity quantity;
};

constexpr std::array<Column, 5> kColumns{{{"X", Quantity::kX},
                                          {"Y", Quantity::kY},
                                          {"left", Quantity::kLeft},
                                          {"right", Quantity::kRight},
                                          {"speed", Quantity::kSpeed}}};
constexpr std::array<Column, 3> kWithoutWidths{kColumns[0], kColumns[1], kColumns[4]};
constexpr std::array<Column, 4> kRaceTrack{{{"x_m", Quantity::kX},
                                            {"y_m", Quantity::kY},
                                            {"w_tr_right_m", Quantity::kRight},
                                            {"w_tr_left_m", Quantity::kLeft}}};

using Header = std::span<const Column>;

constexpr std::array<Header, 4> kHeaders{Header(kColumns).first(2), kWithoutWidths, Header(kColumns).first(4),
                                         kColumns};
constexpr std::string_view kHeaderTexts =
    "\"X,Y\", \"X,Y,speed\", \"X,Y,left,right\", \"X,Y,left,right,speed\" or \"# "
    "x_m,y_m,w_tr_right_m,w_tr_left_m\"";

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

bool Matches(Header header, const std::vector<std::string_view>& fields) {
  return std::ranges::equal(header, fields, {}, &Column::name);
}

// The columns that a line announces; none if it is not a header.
std::optional<Header> HeaderOf(std::string_view line) {
  if (line.starts_with('#')) {
    return Matches(kRaceTrack, Split(line.substr(1))) ? std::optional<Header>(kRaceTrack) : std::nullopt;
  }
  const auto* const found =
      std::ranges::find_if(kHeaders, [&](Header header) { return Matches(header, Split(line)); });
  return found == kHeaders.end() ? std::nullopt : std::optional(*found);
}

struct Limits {
  Range<double> range;
  std::string_view unit;
};

Limits LimitsOf(Quantity quantity) {
  switch (quantity) {
    case Quantity::kLeft:
    case Quantity::kRight:
      return {.range = kWidthRange, .unit = "m"};
    case Quantity::kSpeed:
      return {.range = kSpeedRange, .unit = "m/s"};
    case Quantity::kX:
    case Quantity::kY:
      break;
  }
  return {.range = kPositionRange, .unit = "m"};
}

double ToNumber(const std::string& place, const Column& column, std::string_view field) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) {
    throw ConfigError(
        fmt::format("{} column '{}' = \"{}\" is not a number", place, column.name, Printable(field)));
  }
  const auto [range, unit] = LimitsOf(column.quantity);
  if (value < range.min || value > range.max) {
    throw ConfigError(fmt::format("{} column '{}' = {} is outside [{}, {}] {}", place, column.name, value,
                                  range.min, range.max, unit));
  }
  return value;
}

std::string Names(Header header) {
  std::vector<std::string_view> names;
  for (const Column& column : header) names.push_back(column.name);
  return fmt::format("{}", fmt::join(names, ","));
}

void ReadLine(const std::string& place, Header header, std::string_view line, Waypoints& waypoints) {
  const std::vector<std::string_view> fields = Split(line);
  if (fields.size() != header.size())
    throw ConfigError(fmt::format("{} has {} columns, must be {}", place, fields.size(), Names(header)));
  std::array<std::optional<double>, kColumns.size()> values;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    values[static_cast<std::size_t>(header[i].quantity)] = ToNumber(place, header[i], fields[i]);
  }
  const auto& [X, Y, left, right, speed] = values;
  const Eigen::Vector2d point(*X, *Y);
  if (!waypoints.points.empty() && point == waypoints.points.back())
    throw ConfigError(fmt::format("{} waypoint {},{} repeats its predecessor", place, point.x(), point.y()));
  waypoints.points.push_back(point);
  if (left && right) waypoints.road.push_back({.left = *left, .right = -*right});
  if (speed) waypoints.speeds.push_back(*speed);
}

// Whether the way from the last point of a race track to its first one is missing.
bool IsOpenCircuit(std::span<const Eigen::Vector2d> points) {
  constexpr std::size_t kFewestPoints = 5;  // the ends of a straight line of four are three spacings apart
  constexpr double kWidestGap = 3.0;        // in spacings
  if (points.size() < kFewestPoints) return false;
  std::vector<double> spacings;
  for (std::size_t i = 1; i < points.size(); ++i) spacings.push_back((points[i] - points[i - 1]).norm());
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::ranges::nth_element(spacings, middle);
  const double gap = (points.front() - points.back()).norm();
  return gap > 0.0 && gap <= kWidestGap * *middle;
}

}  // namespace

Waypoints LoadWaypoints(const std::filesystem::path& file) {
  std::istringstream text(WithoutByteOrderMark(ReadTextFile(file)));
  Waypoints waypoints;
  std::optional<Header> header;
  std::string raw;
  for (int number = 1; std::getline(text, raw); ++number) {
    const std::string_view line = Trim(raw);
    if (line.empty()) continue;
    const std::string place = fmt::format("{}:{}:", PlaceName(file), number);
    const bool comment = line.starts_with('#');
    if (header) {
      if (!comment) ReadLine(place, *header, line, waypoints);
      continue;
    }
    header = HeaderOf(line);
    if (!header && !comment)
      throw ConfigError(fmt::format("{} \"{}\" must be the header {}", place, Printable(line), kHeaderTexts));
  }
  if (waypoints.points.size() < 2) {
    throw ConfigError(
        fmt::format("{}: has {} waypoints, must be at least 2", PlaceName(file), waypoints.points.size()));
  }
  if (header->data() == kRaceTrack.data() && IsOpenCircuit(waypoints.points)) {
    waypoints.points.push_back(waypoints.points.front());
    waypoints.road.push_back(waypoints.road.front());
  }
  return waypoints;
}

}  // namespace config
