// The JSON that parts of a sweep are kept in and processes hand on.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/sweep/sweep_result.hpp"

namespace tools {

// {"controller": {"BUCKET": count, ...}, ...} are the times of a part.
struct SweepPart {
  SweepResult result;  // of the shard's scenarios alone
  Shard shard;
};

[[nodiscard]] nlohmann::ordered_json PartJson(const SweepPart& part);
// Throws nlohmann::json::exception: a member is missing or of another kind; std::invalid_argument: a value that cannot
// be, scenarios that are not those of the shard.
[[nodiscard]] SweepPart PartOf(const nlohmann::ordered_json& json);

[[nodiscard]] nlohmann::ordered_json TimedDriveJson(const SweepDrive& drive, const TimeHistogram& times);
// Throws likewise.
void TakeTimedDrive(const nlohmann::ordered_json& json, SweepDrive& drive, TimeHistogram& times);

}  // namespace tools
