#include "tools/shards/shard.hpp"

#include <charconv>
#include <fmt/format.h>
#include <stdexcept>

namespace tools {

std::vector<int> Shard::Indices(int count) const {
  std::vector<int> indices;
  for (int i = index - 1; i < count; i += of) indices.push_back(i);
  return indices;
}

Shard ParseShard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, shard.index);
  if (error == std::errc() && slash != end && *slash == '/') {
    const auto [rest, failure] = std::from_chars(slash + 1, end, shard.of);
    if (failure == std::errc() && rest == end && 1 <= shard.index && shard.index <= shard.of) return shard;
  }
  throw std::invalid_argument(fmt::format("--shard: {} must be i/n with 1 <= i <= n", text));
}

}  // namespace tools
