// Roads and drives as JSON data of a report page (report_page.hpp defines the format).
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "config/route_file.hpp"
#include "control/vehicle/footprint.hpp"
#include "loop/config.hpp"
#include "tools/drive/drive_record.hpp"

namespace tools {

[[nodiscard]] nlohmann::ordered_json RoadData(const config::RouteFile& road);

struct DriveLabel {
  std::string name;                   // shown in legends
  std::string road_key;               // key of the drive's road in the page's data
  control::Footprint footprint = {};  // vehicle; a point is drawn as a mid-size car, for scale
};

// `config` and `road` are those of the drive.
[[nodiscard]] nlohmann::ordered_json DriveData(const DriveRecord& record, const DriveLabel& label,
                                               const loop::Config& config, const config::RouteFile& road);

}  // namespace tools
