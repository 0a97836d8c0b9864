// Values of figures in JSON.
#pragma once

#include <array>
#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

namespace tools {

[[nodiscard]] inline nlohmann::ordered_json OrNull(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

[[nodiscard]] inline std::optional<double> NumberOrNone(const nlohmann::ordered_json& value) {
  if (value.is_null()) return std::nullopt;
  return value.get<double>();
}

// The value of `all` with this name, by NameOf(). Throws std::invalid_argument if there is none.
template <typename Enumeration, std::size_t N>
[[nodiscard]] Enumeration Named(const std::array<Enumeration, N>& all, const std::string& name) {
  for (const Enumeration one : all) {
    if (name == NameOf(one)) return one;
  }
  throw std::invalid_argument(fmt::format("\"{}\" is not a known name", name));
}

}  // namespace tools
