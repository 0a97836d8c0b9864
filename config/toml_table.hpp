// Reads TOML with validation: every error names the file, the line, the key, the value and what is allowed.
//
// Example:
//   const config::TomlTable file = config::TomlTable::Read("lpvmpcd.toml");
//   const config::TomlTable mpc = file.Table("controller");
//   const int horizon = mpc.IntegerOr("horizon", 8, {1, 200});
//   const double left = file.Table("road").Number("left", {0.0, 100.0}, "m");
//   file.RefuseUnknownKeys();  // a key that no call asked for is an error, here and in the tables taken from here
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace config {

// what() is one line: "FILE:LINE: ...".
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <typename T>
struct Range {
  T min = std::numeric_limits<T>::lowest();
  T max = std::numeric_limits<T>::max();
};

class TomlTable {
 public:
  // Throws ConfigError if the file cannot be read or is not TOML.
  [[nodiscard]] static TomlTable Read(const std::filesystem::path& file);
  [[nodiscard]] static TomlTable Parse(std::string_view text, const std::string& source_name);

  // Each throws ConfigError if the key is missing, has another type, or its value is outside the range.
  [[nodiscard]] double Number(std::string_view key, Range<double> range = {},
                              std::string_view unit = "") const;
  [[nodiscard]] int Integer(std::string_view key, Range<int> range = {}) const;
  [[nodiscard]] bool Boolean(std::string_view key) const;
  [[nodiscard]] std::string Text(std::string_view key) const;
  // The value must be one of `choices`; returns its index.
  [[nodiscard]] std::size_t Choice(std::string_view key, const std::vector<std::string>& choices) const;
  // An array of `count` numbers, or of any number of them if `count` is 0.
  [[nodiscard]] std::vector<double> Numbers(std::string_view key, std::size_t count, Range<double> range = {},
                                            std::string_view unit = "") const;
  // A relative path is relative to the folder of this file. An empty one throws ConfigError.
  [[nodiscard]] std::filesystem::path Path(std::string_view key) const;

  // As above, with a default for a missing key.
  [[nodiscard]] double NumberOr(std::string_view key, double fallback, Range<double> range = {},
                                std::string_view unit = "") const;
  [[nodiscard]] int IntegerOr(std::string_view key, int fallback, Range<int> range = {}) const;
  [[nodiscard]] bool BooleanOr(std::string_view key, bool fallback) const;
  [[nodiscard]] std::string TextOr(std::string_view key, const std::string& fallback) const;
  [[nodiscard]] std::size_t ChoiceOr(std::string_view key, std::size_t fallback,
                                     const std::vector<std::string>& choices) const;

  // All values of this table by full key, each as TOML text, for the comparison of two files.
  [[nodiscard]] std::map<std::string, std::string> Values() const;

  [[nodiscard]] bool Has(std::string_view key) const;
  // The table under `key`; an empty one if the key is missing.
  [[nodiscard]] TomlTable Table(std::string_view key) const;
  // The array of tables under `key`; empty if the key is missing.
  [[nodiscard]] std::vector<TomlTable> Tables(std::string_view key) const;

  // Throws ConfigError at the first key, of this table or one taken from it, that no call above asked for.
  void RefuseUnknownKeys() const;

  // Makes an error at `key` (at the table itself if the key is missing), for checks across values.
  [[nodiscard]] ConfigError Error(std::string_view key, std::string_view text) const;

 private:
  struct Node;
  explicit TomlTable(std::shared_ptr<Node> node);
  std::shared_ptr<Node> node_;
};

}  // namespace config
