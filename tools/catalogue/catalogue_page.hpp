// The data of the page about the drives of a catalogue (tools/report/report_page.hpp): a table of all, and for each drive
// what it is for, what was expected of it, and its pictures.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "config/route_file.hpp"
#include "loop/config.hpp"
#include "sim/scenario.hpp"
#include "sim/summary.hpp"
#include "tools/catalogue/drive_catalogue.hpp"
#include "tools/drive/drive_record.hpp"

namespace tools {

// A drive's part of the page: "road", "drive" and its "expectations", a section.
[[nodiscard]] nlohmann::ordered_json ShownDrive(const DriveRecord& record, const sim::Scenario& scenario,
                                                const loop::Config& config, const config::RouteFile& road,
                                                const sim::Summary& summary);

// Of drives that are to be shown.
[[nodiscard]] nlohmann::ordered_json CataloguePage(const std::vector<CatalogueDrive>& drives);

}  // namespace tools
