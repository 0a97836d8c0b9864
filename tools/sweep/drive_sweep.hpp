// The scenarios of a sweep driven, each by each controller, in processes of their own.
#pragma once

#include "tools/sweep/sweep_json.hpp"

namespace tools {

// `jobs` processes at a time, with a bar on stderr. Nothing but the times depends on `jobs`. Throws std::runtime_error:
// a process failed.
[[nodiscard]] SweepPart DriveSweep(const SweepSetup& setup, const Shard& shard, int jobs);

}  // namespace tools
