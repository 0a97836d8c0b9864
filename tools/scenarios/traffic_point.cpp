#include "tools/scenarios/traffic_point.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "tools/scenarios/random.hpp"

namespace tools {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._";
constexpr std::size_t kParts = 4096;  // 64 × 64
static_assert(kDigits.size() == 64);

std::size_t PartOf(double coordinate) {
  const double part = std::floor(coordinate * static_cast<double>(kParts));
  return static_cast<std::size_t>(std::clamp(part, 0.0, static_cast<double>(kParts - 1)));
}

double MiddleOf(std::size_t part) {
  return (static_cast<double>(part) + 0.5) / static_cast<double>(kParts);
}

std::size_t ValueOf(char digit) {
  const std::size_t value = kDigits.find(digit);
  if (value == std::string_view::npos)
    throw std::invalid_argument(fmt::format("--traffic-key: '{}' is no digit of a key", digit));
  return value;
}

}  // namespace

TrafficPoint PointOf(std::uint64_t seed) {
  Random random(seed);
  TrafficPoint point;
  for (double& coordinate : point) coordinate = random.Uniform(0.0, 1.0);
  return point;
}

TrafficPoint OnGrid(const TrafficPoint& point) {
  TrafficPoint grid;
  std::ranges::transform(point, grid.begin(), [](double coordinate) { return MiddleOf(PartOf(coordinate)); });
  return grid;
}

std::string KeyOf(const TrafficPoint& point) {
  std::string key;
  for (const double coordinate : point) {
    const std::size_t part = PartOf(coordinate);
    key += kDigits[part / 64];
    key += kDigits[part % 64];
  }
  return key;
}

TrafficPoint PointOf(std::string_view key) {
  if (key.size() != 2 * kTrafficDimensions) {
    throw std::invalid_argument(fmt::format("--traffic-key: a key has {} digits, this one has {}",
                                            2 * kTrafficDimensions, key.size()));
  }
  TrafficPoint point;
  for (std::size_t i = 0; i < point.size(); ++i)
    point[i] = MiddleOf(64 * ValueOf(key[2 * i]) + ValueOf(key[2 * i + 1]));
  return point;
}

}  // namespace tools
