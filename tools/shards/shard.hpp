// A part of a long command's work, of which many machines do one each.
#pragma once

#include <string>
#include <vector>

namespace tools {

// Part `index`, from 1, of `of` parts: the items index − 1, index − 1 + of, ...
struct Shard {
  int index = 1;
  int of = 1;
  bool operator==(const Shard&) const = default;

  [[nodiscard]] std::vector<int> Indices(int count) const;
};

// Parses "i/n". Throws std::invalid_argument if `text` has another form, or unless 1 <= i <= n.
[[nodiscard]] Shard ParseShard(const std::string& text);

}  // namespace tools
