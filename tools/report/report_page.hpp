// The page of a report: one HTML file that needs nothing else, neither network nor other files. A browser draws it from
// the data, one JSON object:
//
//   {"title": "...",      heading
//    "subtitle": "...",   a line below, may be empty
//    "roads": {KEY: {"reference": LINE, "left": LINE, "right": LINE}},   LINE: {"X": [m], "Y": [m]}
//    "drives": {KEY: DRIVE},
//    "sections": [SECTION, ...]}   in the order of the page
//
// DRIVE:
//   {"name": "...", "controller": "lpv", "horizon": N, "t_s": period [s], "road": KEY,
//    "obstacles": [{"id", "X", "Y" [m], "r_x", "r_y" [m], "heading" [rad], "margin" [m],
//                   "velocity_X", "velocity_Y" [m/s]}, ...]   where they are at t = 0
//    "outline": {"front", "rear", "width" [m]},   the vehicle's rectangle about (X, Y)
//    "limits": {"delta": [min, max], "a": [min, max]},
//    "series": {"t" [s], rising,
//               and as long as t, null where there is no value: "X", "Y" [m], "psi" [rad],
//               "upsilon", "upsilon_ref" [m/s], "delta" [rad], "a" [m/s^2], "solve_time" [us],
//               "scheduling_error", "largest_slack" [trust radii], "active_rows" [1],
//               "solved": 1, 0 (infeasible or failed), null (no problem in this cycle)},
//    "plans": {"k": [index into the series, ...], "dX": [[m, ...], ...], "dY": ...}}
// Plans are the open-loop predictions of steps k, N + 1 points each, relative to X[k], Y[k]; of all steps, of some, or
// absent. Where all scheduling series of a section's drives are null, their plots are left out.
//
// SECTION: {"type", "title" (may be empty), "paragraphs": ["...", ...]} and
//   "text"     nothing more
//   "figures"  "items": [{"label", "value", "verdict": "good" | "bad" | ""}, ...]   tiles
//   "table"    "columns": ["...", ...], "rows": [[CELL, ...], ...], "note"
//              CELL: "..." or {"text", "verdict"}. A column of numbers is aligned right; where
//              rows one after the other have the same first cell, this is shown once
//   "drives"   "drives": [KEY, ...]   overlaid: the plane, once more at each obstacle, and seven plots over time
//              (without scheduling four). Obstacles of several drives that are alike are one
//   "fans"     "fans": [{"title", "drive": KEY, "from": k, "to": k}, ...]   the plans of steps from..to
//   "map"      "speeds": [m/s, ...], "shifts": [m, ...], both rising,
//              "panels": [{"title", "cells": for each shift, for each speed: OUTCOME}, ...],
//              "marks": [{"speed", "shift", "panel": index or null for all, "label"}, ...]
//              OUTCOME: "clear" | "marginal" | "touch" | "infeasible" | "off-road", by rising trouble, | "none"
//              "marginal": the first step that was not solved lacked less than a centimetre
//
// Data of another form are told by the page, at its top and to the browser's log. When everything is drawn, the root
// element has data-ready="1" and data-plots, the number of plots.
#pragma once

#include <string>

namespace tools {

// Any title and any JSON text are safe: neither can end the element that it stands in.
[[nodiscard]] std::string ReportPage(const std::string& title, const std::string& json);

}  // namespace tools
