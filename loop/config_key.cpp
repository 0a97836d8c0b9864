#include "loop/config_key.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace loop {
namespace key_detail {

using config::TomlTable;

void Read(const TomlTable& table, const std::string& name, const Bounds& bounds, double& value) {
  value = table.NumberOr(name, value, {bounds.min, bounds.max}, bounds.unit);
}

void Read(const TomlTable& table, const std::string& name, const Bounds& bounds, int& value) {
  value = table.IntegerOr(name, value, {static_cast<int>(bounds.min), static_cast<int>(bounds.max)});
}

void Read(const TomlTable& table, const std::string& name, const Bounds&, bool& value) {
  value = table.BooleanOr(name, value);
}

void Read(const TomlTable& table, const std::string& name, const Bounds& bounds, base::Time& value) {
  if (table.Has(name)) value = base::FromSeconds(table.Number(name, {bounds.min, bounds.max}, bounds.unit));
}

void Read(const TomlTable& table, const std::string& name, const Bounds& bounds, std::span<double> values) {
  if (table.Has(name)) {
    std::ranges::copy(table.Numbers(name, values.size(), {bounds.min, bounds.max}, bounds.unit),
                      values.begin());
  }
}

// Writes 1e12 instead of 1e+12.
std::string Text(double value) {
  std::string text = fmt::format("{:g}", value);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  const int power = std::stoi(text.substr(exponent + 1));
  return fmt::format("{}e{}", text.substr(0, exponent), power);
}

std::string Text(int value) {
  return fmt::format("{}", value);
}

std::string Text(bool value) {
  return value ? "true" : "false";
}

std::string Text(base::Time value) {
  return Text(base::ToSeconds(value));
}

std::string Text(std::span<const double> values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(Text(value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string Allowed(const Bounds& bounds) {
  if (bounds.min == Bounds().min && bounds.max == Bounds().max) return bounds.unit;
  return fmt::format("{}..{}{}{}", Text(bounds.min), Text(bounds.max), bounds.unit.empty() ? "" : " ",
                     bounds.unit);
}

std::string Allowed(const std::vector<std::string>& choices) {
  return fmt::format("\"{}\"", fmt::join(choices, "\", \""));
}

}  // namespace key_detail

ConfigKey ChoiceKey(const std::string& name, const std::vector<std::string>& choices,
                    const std::function<std::size_t(const Config&)>& get,
                    const std::function<void(Config&, std::size_t)>& set, const std::string& sentence,
                    Reload reload) {
  return {.name = name,
          .default_value = fmt::format("\"{}\"", choices.at(get(Config()))),
          .allowed = key_detail::Allowed(choices),
          .sentence = sentence,
          .read =
              [name, choices, set](const config::TomlTable& table, Config& config) {
                if (table.Has(name)) set(config, table.Choice(name, choices));
              },
          .reload = reload};
}

}  // namespace loop
