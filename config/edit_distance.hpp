// Edit distance between two words, used to suggest the intended key.
#pragma once

#include <cstddef>
#include <string_view>

namespace config {

// The least number of insertions, removals and replacements of characters that turn `a` into `b`.
[[nodiscard]] std::size_t EditDistance(std::string_view a, std::string_view b);

}  // namespace config
