#include "config/toml_document.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/ranges.h>

#include "config/text_file.hpp"

namespace config {
namespace {

std::string FormatValue(const toml::node& node) {
  if (const auto* value = node.as_string()) return fmt::format(" = \"{}\"", Printable(value->get()));
  if (const auto* value = node.as_integer()) return fmt::format(" = {}", value->get());
  if (const auto* value = node.as_floating_point()) return fmt::format(" = {}", value->get());
  if (const auto* value = node.as_boolean()) return fmt::format(" = {}", value->get());
  return "";
}

std::string_view TypeName(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "table";
    case toml::node_type::array:
      return "array";
    case toml::node_type::string:
      return "string";
    case toml::node_type::integer:
      return "integer";
    case toml::node_type::floating_point:
      return "number";
    case toml::node_type::boolean:
      return "boolean";
    default:
      return "date or time";
  }
}

}  // namespace

ConfigError ErrorAt(const Document& document, unsigned line, std::string_view text) {
  return ConfigError(fmt::format("{}:{}: {}", document.name, std::max(line, 1u), text));
}

ConfigError ValueError(const Document& document, std::string_view key, const toml::node& node,
                       std::string_view text) {
  return ErrorAt(document, node.source().begin.line,
                 fmt::format("key '{}'{} {}", Printable(key), FormatValue(node), text));
}

ConfigError TypeError(const Document& document, std::string_view key, const toml::node& node,
                      std::string_view wanted) {
  return ValueError(document, key, node, fmt::format("({}) must be {}", TypeName(node), wanted));
}

double ToNumber(const Document& document, const std::string& key, const toml::node& node,
                const Range<double>& range, std::string_view unit) {
  if (!node.is_number()) throw TypeError(document, key, node, "a number");
  const double value = *node.value<double>();
  if (!std::isfinite(value)) throw ValueError(document, key, node, "is not a finite number");
  if (value < range.min || value > range.max) {
    throw ValueError(document, key, node, fmt::format("is outside {}", FormatRange(range, unit)));
  }
  return value;
}

std::string Join(const std::vector<std::string>& choices) {
  return fmt::format("\"{}\"", fmt::join(choices, "\", \""));
}

}  // namespace config
