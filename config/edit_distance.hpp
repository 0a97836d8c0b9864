// Edit distance of two words, to suggest the key that was meant.
#pragma once

#include <cstddef>
#include <string_view>

namespace config {

// Least number of inserted, removed and replaced characters that turn `a` into `b`.
[[nodiscard]] std::size_t EditDistance(std::string_view a, std::string_view b);

}  // namespace config
