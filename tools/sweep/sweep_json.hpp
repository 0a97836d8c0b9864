// The JSON format of a sweep's parts, and of the results that processes pass on.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/sweep/sweep_result.hpp"

namespace tools {

struct SweepPart {
  SweepResult result;  // result of the shard's scenarios only
  Shard shard;
};

// The member "times" is {"CONTROLLER": {"BUCKET": count, ...}, ...}.
[[nodiscard]] nlohmann::ordered_json PartJson(const SweepPart& part);
// Throws nlohmann::json::exception if a member is missing or of another type; std::invalid_argument if a value is
// impossible or the scenarios are not those of the shard.
[[nodiscard]] SweepPart PartOf(const nlohmann::ordered_json& json);

[[nodiscard]] nlohmann::ordered_json TimedDriveJson(const SweepDrive& drive, const TimeHistogram& times);
// Throws like PartOf().
void TakeTimedDrive(const nlohmann::ordered_json& json, SweepDrive& drive, TimeHistogram& times);

}  // namespace tools
