// Joins the parts of a sweep that `lpvmpc sweep --shard` wrote.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/sweep/sweep_result.hpp"

namespace tools {

// `files` must not be empty. Throws std::runtime_error that names the file if it cannot be read, is not a part, belongs
// to another sweep than the first, or repeats a shard; and one that lists the missing shards.
[[nodiscard]] SweepResult MergeParts(const std::vector<std::filesystem::path>& files);

}  // namespace tools
