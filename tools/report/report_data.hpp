// Roads and drives in the JSON that a report page is drawn from (report_page.hpp tells its form).
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
  std::string name;                   // in legends
  std::string road_key;               // of its road in the page's data
  control::Footprint footprint = {};  // of the vehicle; a point is drawn as a middle-sized car, for scale
};

// `config` and `road` are those that the drive was driven with.
[[nodiscard]] nlohmann::ordered_json DriveData(const DriveRecord& record, const DriveLabel& label,
                                               const loop::Config& config, const config::RouteFile& road);

}  // namespace tools
