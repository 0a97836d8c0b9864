// The page of a report: one self-contained HTML file that needs no network and no other files. The browser draws it
// from its data, one JSON object:
//
//   {"title": "...",      heading
//    "subtitle": "...",   the line below, may be empty
//    "roads": {KEY: {"reference": LINE, "left": LINE, "right": LINE}},   LINE: {"X": [m], "Y": [m]}
//    "drives": {KEY: DRIVE},
//    "sections": [SECTION, ...]}   in the order of the page
//
// DRIVE:
//   {"name": "...", "controller": "lpv", "horizon": N, "t_s": period [s], "road": KEY,
//    "obstacles": [{"id", "shape": "ellipse" | "box", "r_x", "r_y" [m], "margin" [m],
//                   "from", "to": first and last index into the series at which it was there,
//                   "places": {"k": [index, ...], rising from "from" on, and of the same length
//                              "X", "Y" [m], "heading" [rad],
//                              "s": [[arc length of each part of the course that it covers some of [m], ...], ...],
//                              "half_length": [along the course [m], ...]}}, ...]   it stays at each place until the next
//    "decisions": [{"t" [s], rising, "decision", "reason": texts}, ...]   may be empty
//    "outline": {"front", "rear", "width" [m]},   the vehicle's rectangle about (X, Y)
//    "limits": {"delta": [min, max], "a": [min, max]},
//    "series": {"t" [s], rising,
//               and of the same length, null where there is no value: "X", "Y" [m], "psi" [rad],
//               "s": arc length of the course beside the vehicle, "stop": that of the line before which it is to
//               stop [m], "upsilon", "upsilon_ref" [m/s], "delta" [rad], "a" [m/s^2], "solve_time" [us],
//               "scheduling_error", "largest_slack" [trust radii], "active_rows" [1],
//               "solved": 1, 0 (infeasible or failed), null (no problem in this cycle)},
//    "plans": {"k": [index into the series, ...], "dX": [[m, ...], ...], "dY": ...}}
// Plans are the open-loop predictions of steps k, N + 1 points each, relative to X[k], Y[k]. They may cover all steps
// or some, or be absent. If all scheduling series of a section's drives are null, their plots are omitted.
//
// SECTION: {"type", "title" (may be empty), "paragraphs": ["...", ...]} and
//   "text"     no further members
//   "figures"  "items": [{"label", "value", "verdict": "good" | "bad" | ""}, ...]   tiles
//   "table"    "columns": ["...", ...], "rows": [[CELL, ...], ...], "note"
//              CELL: "..." or {"text", "verdict"}. A column of numbers is right-aligned; a first
//              cell that consecutive rows share is shown once
//   "drives"   "drives": [KEY, ...]   overlaid: the plane, again at each of the obstacles that were come near to (the
//              nearest six), and seven plots over time (four without scheduling); and for each drive with decisions,
//              the course over time with all that is on it, beside the list of the decisions. Identical obstacles of
//              several drives are shown once
//   "fans"     "fans": [{"title", "drive": KEY, "from": k, "to": k}, ...]   the plans of steps from..to
//   "map"      "speeds": [m/s, ...], "shifts": [m, ...], both rising,
//              "panels": [{"title", "cells": for each shift, for each speed: OUTCOME}, ...],
//              "marks": [{"speed", "shift", "panel": index or null for all, "label"}, ...]
//              OUTCOME: "clear" | "marginal" | "touch" | "infeasible" | "off-road", from best to worst, | "none"
//              "marginal": the first unsolved step was short of an obstacle by less than a centimetre
//   "fold"     "verdict": "good" | "bad" | "", "sections": [SECTION, ...]   closed until the reader opens it, and drawn
//              only then
//
// The page reports data of any other form at its top and in the browser's log. When everything is drawn without a
// fault, the root element has data-ready="1" and data-plots, the number of plots outside folds.
#pragma once

#include <string>

namespace tools {

// Any title and any JSON text are safe: neither can end the element that contains it.
[[nodiscard]] std::string ReportPage(const std::string& title, const std::string& json);

}  // namespace tools
