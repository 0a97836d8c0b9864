// A key of the daemon's configuration file: how it is read, its description in the manual, and when a running daemon
// may apply a change.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/time.hpp"
#include "config/toml_table.hpp"
#include "loop/config.hpp"

namespace loop {

enum class Reload : std::uint8_t {
  kNeedsRestart,
  kWhileNotCommanding,  // while no commands are enabled
  kAlways,
};

// Range of allowed values of a number, both ends included.
struct Bounds {
  double min = std::numeric_limits<double>::lowest();
  double max = std::numeric_limits<double>::max();
  std::string unit;
};

struct ConfigKey {
  std::string name;
  std::string default_value;  // as written in the file, or the rule that derives it from other keys
  std::string allowed;        // values and unit, as in the manual; may be empty
  std::string sentence;       // description in the manual, without the full stop
  // Reads the key if it is in the table. Throws config::ConfigError if it is missing but required, or not allowed.
  std::function<void(const config::TomlTable& table, Config& config)> read;
  Reload reload = Reload::kNeedsRestart;
};

namespace key_detail {

void Read(const config::TomlTable& table, const std::string& name, const Bounds& bounds, double& value);
void Read(const config::TomlTable& table, const std::string& name, const Bounds& bounds, int& value);
void Read(const config::TomlTable& table, const std::string& name, const Bounds& bounds, bool& value);
void Read(const config::TomlTable& table, const std::string& name, const Bounds& bounds, base::Time& value);
void Read(const config::TomlTable& table, const std::string& name, const Bounds& bounds,
          std::span<double> values);

[[nodiscard]] std::string Text(double value);
[[nodiscard]] std::string Text(int value);
[[nodiscard]] std::string Text(bool value);
[[nodiscard]] std::string Text(base::Time value);  // [s]
[[nodiscard]] std::string Text(std::span<const double> values);

[[nodiscard]] std::string Allowed(const Bounds& bounds);
[[nodiscard]] std::string Allowed(const std::vector<std::string>& choices);

}  // namespace key_detail

// A key whose value is a member of Config: a number, a boolean, a time in seconds or a vector. `place` returns its
// address: [](Config& c) { return &c.loop.limits.max_steering; }. The member's default is the key's default.
template <typename Place>
ConfigKey Key(const std::string& name, Place place, const Bounds& bounds, const std::string& sentence,
              Reload reload = Reload::kNeedsRestart) {
  // A vector is handled as a span of its numbers.
  const auto value = [place](Config& config) -> decltype(auto) {
    if constexpr (requires { place(config)->data(); }) {
      return std::span<double>(place(config)->data(), static_cast<std::size_t>(place(config)->size()));
    } else {
      return *place(config);
    }
  };
  Config defaults;
  return {.name = name,
          .default_value = key_detail::Text(value(defaults)),
          .allowed = key_detail::Allowed(bounds),
          .sentence = sentence,
          .read =
              [name, value, bounds](const config::TomlTable& table, Config& config) {
                auto&& read = value(config);
                key_detail::Read(table, name, bounds, read);
              },
          .reload = reload};
}

// A key for a number or vector that is derived from other keys by `rule` if it is not given.
template <typename Place>
ConfigKey OptionalKey(const std::string& name, Place place, const Bounds& bounds, const std::string& rule,
                      const std::string& sentence, Reload reload = Reload::kNeedsRestart) {
  return {
      .name = name,
      .default_value = rule,
      .allowed = key_detail::Allowed(bounds),
      .sentence = sentence,
      .read =
          [name, place, bounds](const config::TomlTable& table, Config& config) {
            if (!table.Has(name)) return;
            auto& value = place(config)->emplace();
            if constexpr (requires { value.data(); }) {
              key_detail::Read(table, name, bounds, {value.data(), static_cast<std::size_t>(value.size())});
            } else {
              key_detail::Read(table, name, bounds, value);
            }
          },
      .reload = reload};
}

// A key whose value is one of `choices`; `set` takes the index.
[[nodiscard]] ConfigKey ChoiceKey(const std::string& name, const std::vector<std::string>& choices,
                                  const std::function<std::size_t(const Config&)>& get,
                                  const std::function<void(Config&, std::size_t)>& set,
                                  const std::string& sentence, Reload reload = Reload::kNeedsRestart);

}  // namespace loop
