// The objects of a drive as JSON data of a report page (report_page.hpp): where they were, and where on the course.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "config/route_file.hpp"
#include "tools/drive/drive_record.hpp"

namespace tools {

// The objects that were reported in the time of the record's samples. `margin`: drawn about each [m].
[[nodiscard]] nlohmann::ordered_json ObjectsData(const DriveRecord& record, double margin,
                                                 const config::RouteFile& road);

}  // namespace tools
