// Drives every scenario of a sweep with every controller, each drive in its own process.
#pragma once

#include "tools/sweep/sweep_json.hpp"

namespace tools {

// Runs `jobs` processes at a time, with a progress bar on stderr. Only the times depend on `jobs`. Throws
// std::runtime_error if a process fails.
[[nodiscard]] SweepPart DriveSweep(const SweepSetup& setup, const Shard& shard, int jobs);

}  // namespace tools
