// The parts of a sweep, as `lpvmpc sweep --shard` wrote them, joined.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/sweep/sweep_result.hpp"

namespace tools {

// Throws std::runtime_error that names the file: it cannot be read, is no part, is of another sweep than the first, or a
// shard that was there before; and the shards that no file is of.
[[nodiscard]] SweepResult MergeParts(const std::vector<std::filesystem::path>& files);

}  // namespace tools
