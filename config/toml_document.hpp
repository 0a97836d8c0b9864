// A parsed TOML file and the errors that name a place in it, for TomlTable.
#pragma once

#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "config/toml_table.hpp"

namespace config {

struct Document {
  std::string name;
  std::filesystem::path folder;
  toml::table root;
};

// Only a number can lack a bound: an integer has at least the bounds of int.
template <typename T>
[[nodiscard]] std::string FormatRange(const Range<T>& range, std::string_view unit) {
  constexpr bool kHasInfinity = std::numeric_limits<T>::has_infinity;
  const bool no_min = kHasInfinity && range.min == Range<T>{}.min;
  const bool no_max = kHasInfinity && range.max == Range<T>{}.max;
  return fmt::format("{}, {}{}{}", no_min ? "(-inf" : fmt::format("[{}", range.min),
                     no_max ? "inf)" : fmt::format("{}]", range.max), unit.empty() ? "" : " ", unit);
}

[[nodiscard]] ConfigError ErrorAt(const Document& document, unsigned line, std::string_view text);
// "FILE:LINE: key 'KEY' = VALUE `text`".
[[nodiscard]] ConfigError ValueError(const Document& document, std::string_view key, const toml::node& node,
                                     std::string_view text);
[[nodiscard]] ConfigError TypeError(const Document& document, std::string_view key, const toml::node& node,
                                    std::string_view wanted);

// A finite number within the range. Throws ConfigError otherwise.
[[nodiscard]] double ToNumber(const Document& document, const std::string& key, const toml::node& node,
                              const Range<double>& range, std::string_view unit);

// "a", "b", in quotes.
[[nodiscard]] std::string Join(const std::vector<std::string>& choices);

}  // namespace config
