#include "config/toml_table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>
#include <sstream>

#include <toml++/toml.h>

#include "config/edit_distance.hpp"
#include "config/text_file.hpp"
#include "config/toml_document.hpp"

namespace config {
namespace {

void CollectValues(const toml::table& table, const std::string& prefix,
                   std::map<std::string, std::string>& values) {
  for (const auto& [key, value] : table) {
    const std::string full_key = prefix + std::string(key.str());
    if (const toml::table* child = value.as_table()) {
      CollectValues(*child, full_key + ".", values);
    } else {
      std::ostringstream text;
      value.visit([&text](const auto& node) { text << node; });
      values.emplace(full_key, text.str());
    }
  }
}

}  // namespace

struct TomlTable::Node {
  std::shared_ptr<const Document> document;
  const toml::table* table = nullptr;  // null: not in the file
  std::string prefix;                  // prefix of the full keys: "" or ending in a dot
  unsigned line = 1;
  std::set<std::string, std::less<>> asked;
  std::map<std::string, std::vector<std::shared_ptr<Node>>, std::less<>> children;

  std::string FullKey(std::string_view key) const { return prefix + std::string(key); }

  const toml::node* Find(std::string_view key) {
    asked.emplace(key);
    return table == nullptr ? nullptr : table->get(key);
  }

  const toml::node& Get(std::string_view key, std::string_view wanted) {
    const toml::node* node = Find(key);
    if (node == nullptr) {
      throw ErrorAt(*document, line, fmt::format("key '{}' is missing ({})", FullKey(key), wanted));
    }
    return *node;
  }

  std::shared_ptr<Node> Child(const toml::table* child, const std::string& key) const {
    return std::make_shared<Node>(Node{.document = document,
                                       .table = child,
                                       .prefix = key + ".",
                                       .line = child == nullptr ? line : child->source().begin.line,
                                       .asked = {},
                                       .children = {}});
  }

  struct Unknown {
    unsigned line;
    std::string text;
  };
  void CollectUnknown(std::vector<Unknown>& unknown) const {
    if (table != nullptr) {
      for (const auto& [key, value] : *table) {
        if (asked.contains(key.str())) continue;
        std::string text = fmt::format("unknown key '{}'", Printable(FullKey(key.str())));
        const std::string nearest = Nearest(key.str());
        if (!nearest.empty()) text += fmt::format(", is '{}' meant?", FullKey(nearest));
        unknown.push_back({value.source().begin.line, text});
      }
    }
    for (const auto& [key, nodes] : children) {
      for (const std::shared_ptr<Node>& node : nodes) node->CollectUnknown(unknown);
    }
  }
  std::string Nearest(std::string_view key) const {
    std::string nearest;
    std::size_t best = 3;  // more than two slips make a different word
    for (const std::string& candidate : asked) {
      const std::size_t distance = EditDistance(key, candidate);
      if (distance < best && distance < candidate.size() && !table->contains(candidate)) {
        best = distance;
        nearest = candidate;
      }
    }
    return nearest;
  }
};

TomlTable::TomlTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}

TomlTable TomlTable::Read(const std::filesystem::path& file) {
  return Parse(ReadTextFile(file), file.string());
}

TomlTable TomlTable::Parse(std::string_view text, const std::string& source_name) {
  auto document = std::make_shared<Document>();
  document->name = PlaceName(source_name);
  document->folder = std::filesystem::path(source_name).parent_path();
  try {
    document->root = toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    throw ErrorAt(*document, error.source().begin.line, Printable(error.description()));
  }
  auto node = std::make_shared<Node>();
  node->table = &document->root;
  node->document = std::move(document);
  return TomlTable(std::move(node));
}

double TomlTable::Number(std::string_view key, Range<double> range, std::string_view unit) const {
  const toml::node& node = node_->Get(key, fmt::format("a number in {}", FormatRange(range, unit)));
  return ToNumber(*node_->document, node_->FullKey(key), node, range, unit);
}

int TomlTable::Integer(std::string_view key, Range<int> range) const {
  const toml::node& node = node_->Get(key, fmt::format("an integer in {}", FormatRange(range, "")));
  if (!node.is_integer()) throw TypeError(*node_->document, node_->FullKey(key), node, "an integer");
  const std::int64_t value = *node.value<std::int64_t>();
  if (value < range.min || value > range.max) {
    throw ValueError(*node_->document, node_->FullKey(key), node,
                     fmt::format("is outside {}", FormatRange(range, "")));
  }
  return static_cast<int>(value);
}

bool TomlTable::Boolean(std::string_view key) const {
  const toml::node& node = node_->Get(key, "true or false");
  if (!node.is_boolean()) throw TypeError(*node_->document, node_->FullKey(key), node, "true or false");
  return *node.value<bool>();
}

std::string TomlTable::Text(std::string_view key) const {
  const toml::node& node = node_->Get(key, "a string");
  if (!node.is_string()) throw TypeError(*node_->document, node_->FullKey(key), node, "a string");
  return *node.value<std::string>();
}

std::size_t TomlTable::Choice(std::string_view key, const std::vector<std::string>& choices) const {
  const toml::node& node = node_->Get(key, fmt::format("one of {}", Join(choices)));
  if (!node.is_string())
    throw TypeError(*node_->document, node_->FullKey(key), node, fmt::format("one of {}", Join(choices)));
  const auto found = std::ranges::find(choices, *node.value<std::string>());
  if (found == choices.end()) {
    throw ValueError(*node_->document, node_->FullKey(key), node,
                     fmt::format("must be one of {}", Join(choices)));
  }
  return static_cast<std::size_t>(found - choices.begin());
}

std::vector<double> TomlTable::Numbers(std::string_view key, std::size_t count, Range<double> range,
                                       std::string_view unit) const {
  const std::string wanted =
      count == 0 ? "an array of numbers" : fmt::format("an array of {} numbers", count);
  const toml::node& node = node_->Get(key, wanted);
  const toml::array* array = node.as_array();
  if (array == nullptr) throw TypeError(*node_->document, node_->FullKey(key), node, wanted);
  if (count != 0 && array->size() != count) {
    throw ValueError(*node_->document, node_->FullKey(key), node,
                     fmt::format("has {} elements, must be {}", array->size(), wanted));
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string element = fmt::format("{}[{}]", node_->FullKey(key), i);
    values.push_back(ToNumber(*node_->document, element, *array->get(i), range, unit));
  }
  return values;
}

std::filesystem::path TomlTable::Path(std::string_view key) const {
  const std::string text = Text(key);
  if (text.empty()) throw Error(key, "must not be empty");
  return (node_->document->folder / text).lexically_normal();
}

double TomlTable::NumberOr(std::string_view key, double fallback, Range<double> range,
                           std::string_view unit) const {
  return Has(key) ? Number(key, range, unit) : fallback;
}

int TomlTable::IntegerOr(std::string_view key, int fallback, Range<int> range) const {
  return Has(key) ? Integer(key, range) : fallback;
}

bool TomlTable::BooleanOr(std::string_view key, bool fallback) const {
  return Has(key) ? Boolean(key) : fallback;
}

std::string TomlTable::TextOr(std::string_view key, const std::string& fallback) const {
  return Has(key) ? Text(key) : fallback;
}

std::size_t TomlTable::ChoiceOr(std::string_view key, std::size_t fallback,
                                const std::vector<std::string>& choices) const {
  return Has(key) ? Choice(key, choices) : fallback;
}

std::map<std::string, std::string> TomlTable::Values() const {
  std::map<std::string, std::string> values;
  if (node_->table != nullptr) CollectValues(*node_->table, node_->prefix, values);
  return values;
}

bool TomlTable::Has(std::string_view key) const {
  return node_->Find(key) != nullptr;
}

TomlTable TomlTable::Table(std::string_view key) const {
  const toml::node* node = node_->Find(key);
  if (node != nullptr && !node->is_table()) {
    throw TypeError(*node_->document, node_->FullKey(key), *node, "a table");
  }
  auto& children = node_->children[std::string(key)];
  if (children.empty()) {
    children.push_back(node_->Child(node == nullptr ? nullptr : node->as_table(), node_->FullKey(key)));
  }
  return TomlTable(children.front());
}

std::vector<TomlTable> TomlTable::Tables(std::string_view key) const {
  const toml::node* node = node_->Find(key);
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  if (array == nullptr) throw TypeError(*node_->document, node_->FullKey(key), *node, "an array of tables");
  auto& children = node_->children[std::string(key)];
  std::vector<TomlTable> tables;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string element = fmt::format("{}[{}]", node_->FullKey(key), i);
    const toml::table* table = array->get(i)->as_table();
    if (table == nullptr) throw TypeError(*node_->document, element, *array->get(i), "a table");
    if (children.size() <= i) children.push_back(node_->Child(table, element));
    tables.push_back(TomlTable(children[i]));
  }
  return tables;
}

void TomlTable::RefuseUnknownKeys() const {
  std::vector<Node::Unknown> unknown;
  node_->CollectUnknown(unknown);
  if (unknown.empty()) return;
  const auto first = std::ranges::min_element(unknown, {}, &Node::Unknown::line);
  throw ErrorAt(*node_->document, first->line, first->text);
}

ConfigError TomlTable::Error(std::string_view key, std::string_view text) const {
  const toml::node* node = node_->Find(key);
  if (node != nullptr) return ValueError(*node_->document, node_->FullKey(key), *node, text);
  return ErrorAt(*node_->document, node_->line, fmt::format("key '{}' {}", node_->FullKey(key), text));
}

}  // namespace config
